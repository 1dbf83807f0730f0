# Sourced by the scripts beside it: installs what is missing, builds in a workspace of its
# own, and sets up the environment. It may run again at any time.
#
# SELF_AWARENESS_WORKSPACE  the catkin workspace; by default a folder of its own for every checkout
#                           under ~/.cache/self_awareness

set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
workspace=${SELF_AWARENESS_WORKSPACE:-${XDG_CACHE_HOME:-$HOME/.cache}/self_awareness/$(
  echo "$checkout" | cksum | cut -d ' ' -f 1)}

# ROS 1 is installed for the system's Python; another one may come first on the path.
export PATH=/usr/bin:/bin:$PATH

packages_debian=(
  ca-certificates g++ make cmake python3-dev python3-setuptools
  catkin ros-base-dev ros-message-generation
  libnodeletlib-dev libnodelet-dev libnodeletlib-tools
  libdiagnostic-updater-dev libdiagnostic-aggregator-dev libdiagnostic-aggregator-tools
  librosbag-dev librosbag-storage-dev libroslz4-dev libtopic-tools-dev topic-tools librostest-dev
  python3-rosbag python3-rospy python3-rostest python3-roslaunch python3-rosnode python3-rostopic
  python3-rosmsg python3-rosservice python3-rosgraph rosbash rosdiagnostic
  python3-actionlib-msgs python3-diagnostic-msgs python3-geometry-msgs python3-nav-msgs python3-sensor-msgs
  python3-nodelet python3-std-srvs python3-visualization-msgs
  libvisualization-msgs-dev libsensor-msgs-dev libstd-srvs-dev
  pybind11-dev libboost-filesystem-dev libeigen3-dev libre2-dev pkg-config
  python3-numpy python3-matplotlib python3-tqdm python3-yaml python3-jinja2 python3-plotly python3-urwid graphviz
  libgtest-dev libgmock-dev nlohmann-json3-dev procps
)
# Without these, the tests cannot run, or leave something out; all else can.
packages_debian_tests=(
  chromium chromium-driver python3-selenium poppler-utils
  catkin-lint clang-format clang-tidy doxygen libfaketime
  python3-pytest python3-pytest-xdist
  python3-hypothesis python3-flake8 python3-mypy
  # Debian 11's distributed imports tornado, but its package does not depend on it.
  python3-distributed python3-tornado
)
packages_noetic=(
  g++ make cmake python3-dev python3-setuptools
  ros-noetic-ros-base ros-noetic-nodelet ros-noetic-pluginlib ros-noetic-diagnostic-updater
  ros-noetic-diagnostic-aggregator ros-noetic-diagnostic-msgs ros-noetic-topic-tools
  ros-noetic-rosbag ros-noetic-rosbag-storage ros-noetic-roslz4 ros-noetic-std-srvs ros-noetic-rosbash
  ros-noetic-actionlib-msgs ros-noetic-visualization-msgs ros-noetic-sensor-msgs ros-noetic-nav-msgs
  ros-noetic-geometry-msgs
  pybind11-dev libboost-filesystem-dev libeigen3-dev libre2-dev pkg-config
  python3-numpy python3-matplotlib python3-tqdm python3-yaml python3-jinja2 python3-plotly python3-urwid graphviz
  ros-noetic-rostest ros-noetic-roslaunch libgtest-dev libgmock-dev nlohmann-json3-dev procps
)
packages_noetic_tests=(
  libfaketime python3-pytest python3-pytest-xdist python3-hypothesis python3-catkin-lint clang-format
  python3-distributed python3-flake8 python3-mypy
)

say() { printf '\n== %s\n' "$*"; }

say_time() {  # WHAT SINCE: how long it took, since a value of SECONDS
  printf '%s took %d min %d s\n' "$1" $(((SECONDS - $2) / 60)) $(((SECONDS - $2) % 60))
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

installed() {
  [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# install_packages [without-tests]
install_packages() {
  local wanted=("${packages_debian[@]}") tests=("${packages_debian_tests[@]}")
  if [ -d /opt/ros/noetic ]; then
    wanted=("${packages_noetic[@]}")
    tests=("${packages_noetic_tests[@]}")
  fi
  [ "${1:-}" = without-tests ] || wanted+=("${tests[@]}")
  install_apt "${wanted[@]}"
}

# install_apt PACKAGE...
install_apt() {
  local missing=() package begin=$SECONDS
  for package in "$@"; do
    installed "$package" || missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  say "Installing ${#missing[@]} packages"
  as_root apt-get update -qq -o DPkg::Lock::Timeout=300
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq -o DPkg::Lock::Timeout=300 --no-install-recommends \
    "${missing[@]}" > /dev/null
  say_time "Installing packages" "$begin"
}

source_ros() {  # ROS's setup files use variables that are not set
  set +u
  # shellcheck disable=SC1090
  source "$1"
  set -u
}

on_debian_11() { [ "$(. /etc/os-release && echo "$ID-${VERSION_ID:-}")" = debian-11 ]; }

# Masters and nodes of tests stay on this machine, whatever its name resolves to.
use_loopback() {
  export ROS_IP=127.0.0.1
  unset ROS_HOSTNAME ROS_MASTER_URI ROS_NAMESPACE
}

# build [TARGET...]
build() {
  say "Building in $workspace"
  mkdir -p "$workspace/src"
  ln -sfn "$checkout" "$workspace/src/self_awareness"
  [ ! -d /opt/ros/noetic ] || source_ros /opt/ros/noetic/setup.bash
  local options=(-DPYTHON_EXECUTABLE=/usr/bin/python3) begin=$SECONDS
  # Debian 11's catkin caches that it has found GMock: a second run of CMake does not look for it
  # again, and has no targets of gtest. Without GMock, catkin builds gtest from its sources.
  ! on_debian_11 || options+=(-DCMAKE_DISABLE_FIND_PACKAGE_GMock=TRUE)
  find_plugins_of_debian_11
  # "|| return", because set -e has no effect inside a condition.
  # With -j alone: by default, catkin_make starts nothing while the load is high, which a build makes it.
  catkin_make --directory "$workspace" -j"$(nproc)" "${options[@]}" "$@" || return
  say_time Building "$begin"
  source_ros "$workspace/devel/setup.bash"
  find_plugins_of_debian_11
}

# Debian 11's pluginlib does not look where Debian 11 installs the libraries of plugins, such as
# those of diagnostic_aggregator. It does look in a prefix that has them in lib/. Tests have the
# prefixes that were there before CMake ran.
find_plugins_of_debian_11() {
  on_debian_11 || return 0
  local prefix=$workspace/debian-11
  mkdir -p "$prefix"
  ln -sfn "/usr/lib/$(gcc -dumpmachine)" "$prefix/lib"
  [[ :${CMAKE_PREFIX_PATH:-}: == *:$prefix:* ]] ||
    export CMAKE_PREFIX_PATH=${CMAKE_PREFIX_PATH:+$CMAKE_PREFIX_PATH:}$prefix
}

#!/usr/bin/env bash
# Makes a Debian 11 as near to Noetic on Ubuntu 20.04 as packages allow, looks whether the Python code
# is that of Python 3.8, and runs a command. It replaces the system's compiler, CMake and libraries:
# for a system that serves nothing else (scripts/test_platform.sh noetic).
#
# usage: scripts/near_noetic.sh COMMAND...
#
# docs/developers.md lists the versions, and what is newer or older than in Noetic all the same.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

if ! on_debian_11; then
  echo "near_noetic.sh: error: this is no Debian 11; run scripts/test_platform.sh noetic" >&2
  exit 1
fi

# Versions of Ubuntu 20.04, where PyPI has them for the Python of Debian 11.
wheels=(cmake==3.16.3.post1 pybind11==2.4.3 Jinja2==2.10.1 tqdm==4.30.0 pytest==4.6.9
  pytest-xdist==1.29.0 hypothesis==4.36.2)
vermin=vermin==1.6.0

# replace PROGRAM BY: where each finds it, whatever comes first on its path
replace() {
  [ "$(readlink -f "$1")" != "$(readlink -f "$2")" ] || return 0
  dpkg-divert --quiet --rename --add "$1"
  ln -sf "$2" "$1"
}

install_packages
install_apt g++-9 python3-pip
say "Installing ${wheels[*]}"
certificates=/etc/certificates.crt  # those of the machine that test_platform.sh runs on
[ ! -e "$certificates" ] || export PIP_CERT=$certificates
pip3 install --quiet --no-warn-script-location "${wheels[@]}" "$vermin"
replace /usr/bin/g++ /usr/bin/g++-9
replace /usr/bin/c++ /usr/bin/g++-9
replace /usr/bin/gcc /usr/bin/gcc-9
replace /usr/bin/cmake "$(/usr/bin/python3 -c 'import cmake; print(cmake.CMAKE_BIN_DIR)')/cmake"
# The headers of pybind11 2.4.3 come without what CMake reads: they come before those of Debian.
headers=$(/usr/bin/python3 -c 'import pybind11; print(pybind11.get_include())')
[ -e "$headers/pybind11/pybind11.h" ] || { echo "near_noetic.sh: error: no $headers" >&2; exit 1; }
export CPLUS_INCLUDE_PATH=$headers
# Python 3.9 has dropped what rospy 1.15.9 calls when a node ends; that of Noetic has it.
packages=$(/usr/bin/python3 -c 'import site; print(site.getsitepackages()[0])')
mkdir -p "$packages"
echo 'import threading; threading.Thread.isAlive = threading.Thread.is_alive' \
  > "$packages/threads_of_python_3_8.pth"

say "Python 3.8"
grep -lE '^#!/usr/bin/python3' nodes/* scripts/* |
  xargs /usr/local/bin/vermin --quiet --no-tips --target=3.8- --violations benchmark setup.py src test

say "Running with $(g++ --version | head -n 1), $(cmake --version | head -n 1)"
exec "$@"

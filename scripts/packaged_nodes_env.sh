#!/usr/bin/env bash
# Runs a command after installing the packages of Debian 12 whose nodes `evaluate nodes` watches.
#
#   scripts/packaged_nodes_env.sh rosrun self_awareness evaluate nodes

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

packages=(
  # Cameras and what is made of their pictures; the -dev packages hold the lists of nodelets.
  ros-image-publisher libimage-publisher-dev
  ros-image-proc libimage-proc-dev
  libdepth-image-proc-dev
  ros-opencv-apps libopencv-apps-dev
  # Transforms; buffer_server is an action server.
  ros-robot-state-publisher joint-state-publisher
  tf-tools libtf-dev
  tf2-tools
  # Managers of nodelets, replays, relays, and tools that publish.
  libnodeletlib-tools python3-rosbag librosbag-dev topic-tools python3-rosnode
  python3-rostopic python3-dynamic-reconfigure
  # Diagnostics.
  libdiagnostic-aggregator-tools python3-diagnostic-common-diagnostics python3-diagnostic-updater
  python3-psutil
)

install_apt "${packages[@]}"
exec "$@"

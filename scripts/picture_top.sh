#!/usr/bin/env bash
# Makes docs/top.png: the live view of the simulated robot, whose laser driver was killed, as a terminal shows it.
#
# usage: scripts/picture_top.sh [FOLDER]     of scripts/demo.sh, which makes the model; out/ in the checkout by default

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"
source "$(dirname "${BASH_SOURCE[0]}")/processes.sh"

out=$(mkdir -p "${1:-$checkout/out}" && cd "${1:-$checkout/out}" && pwd)
[ -f "$out/calibrated.model" ] || "$checkout/scripts/demo.sh" "$out"
build

port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_LOG_DIR=$out/log
trap stop_all EXIT

says() {  # WHAT: the monitor's status
  timeout 5 rostopic echo -n 1 "/diagnostics/status[0]/message" | grep -q "$1"
}

say "Starting the simulated robot and the monitor"
rm -rf "$out/top"
printf 'recorder: {directory: "%s"}\n' "$out/top" > "$out/top.yaml"
start roscore.log roscore -p "$port"
await 30 "the master answers" rosnode list
start robot.log roslaunch --wait self_awareness follow_me.launch
start monitor.log roslaunch --wait self_awareness monitor.launch model:="$out/calibrated.model" \
  config:="$out/top.yaml"
await 120 "the monitor is quiet" rosservice info /self_awareness/mute
await 120 "the monitor is quiet" says 'normal communication'

say "Making docs/top.png"
/usr/bin/python3 -m self_awareness_evaluation.terminal_picture "$checkout/docs/top.png" '/player silent' rosrun self_awareness top &
picture=$!
rosservice call /self_awareness/mute "{component: /battery, duration: 600}"
sleep 20
rosrun self_awareness induce crash:player
watch $picture

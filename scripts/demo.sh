#!/usr/bin/env bash
# Shows the whole way on a simulated robot of 15 nodes: build, record normal runs, train,
# calibrate, run the monitor with a diagnostic_aggregator, kill the laser driver, print the alarm, make
# the report of it.
#
# usage: scripts/demo.sh [FOLDER]     where all files go; out/ in the checkout by default
#
# Exit code 0 only if the alarm came, and none before the fault, and if the report names who was
# killed, and the flight record of the alarm is there.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"
source "$(dirname "${BASH_SOURCE[0]}")/processes.sh"

out=$(mkdir -p "${1:-$checkout/out}" && cd "${1:-$checkout/out}" && pwd)
run_seconds=60

install_packages without-tests
build > >(tee "$out/build.log" | progress_of_make) 2>&1 || { tail -n 40 "$out/build.log" >&2; exit 1; }

# The demo has its own master, on a free port of the loopback interface.
port=$(/usr/bin/python3 -c 'from self_awareness_evaluation.live import processes
print(processes.free_port())')
export ROS_MASTER_URI=http://127.0.0.1:$port ROS_IP=127.0.0.1 ROS_LOG_DIR=$out/log
unset ROS_HOSTNAME

trap stop_all EXIT

heard() { timeout 5 rostopic echo -n 1 "$1"; }

record() {  # NAME SECONDS
  rm -f "$out/$1.bag" "$out/$1.bag.active"
  rosbag record --all --exclude '/rosout_agg|/self_awareness/.*|/diagnostics.*' --quiet \
    --output-name "$out/$1.bag" --duration "$2" __name:=record > "$out/$1.log" 2>&1 &
  local recorder=$!
  /usr/bin/python3 -c "
from self_awareness.progress import waiting
for _ in waiting($2, '$1'): pass" &
  local bar=$!
  watch $recorder || fail_with_log "$1.log" "rosbag record failed"
  wait $bar
}

# Of another demo; nothing else that may lie in the folder.
rm -f "$out"/fault.bag{,.active} "$out"/{trained,calibrated}.model "$out"/{roc,score}.png \
  "$out"/report.html

say "Starting the simulated robot (launch/follow_me.launch)"
start roscore.log roscore -p "$port"
await 30 "the master answers" rosnode list
start robot.log roslaunch --wait self_awareness follow_me.launch
for topic in odom scan pose tracks faces joint_states battery task/state; do
  await 90 "the robot publishes /$topic" heard "/$topic"
done

say "Recording four normal runs of $run_seconds s"
start graph.log rosrun self_awareness record_graph "$out/normal"
for run in normal_1 normal_2 normal_3 normal_4; do record $run $run_seconds; done

say "Training on two of them, calibrating on the others"
rosrun self_awareness train "$out/normal_1.bag" "$out/normal_2.bag" -o "$out/trained.model"
rosrun self_awareness calibrate --model "$out/trained.model" \
  --normal "$out/normal_3.bag" "$out/normal_4.bag" \
  --inject 'crash:*' slow:/motors:2 starve \
  --roc "$out/roc.png" -o "$out/calibrated.model"

say "Starting the monitor and a diagnostic_aggregator"
printf 'recorder: {directory: "%s"}\n' "$out" > "$out/monitor.yaml"
start monitor.log roslaunch --wait self_awareness monitor.launch model:="$out/calibrated.model" \
  config:="$out/monitor.yaml"
start diagnostics.log roslaunch --wait self_awareness diagnostics.launch
rosbag record --all --exclude '/rosout_agg|/self_awareness/.*|/diagnostics.*' --quiet \
  --output-name "$out/fault.bag" __name:=record > "$out/fault.log" 2>&1 &
recorder=$!
verdict=0
rosrun self_awareness demo_fault &
watch $! || verdict=$?
kill -INT $recorder
wait $recorder || true

say "The same from the bag that was recorded meanwhile"
rosrun self_awareness score "$out/fault.bag" --model "$out/calibrated.model" \
  --report "$out/report.html" --plot "$out/score.png"

if [ $verdict -ne 0 ]; then
  echo "demo: error: there was no alarm as expected, see above; the logs are $out/*.log" >&2
  exit $verdict
fi

stop_all  # the monitor ends its flight record
leaves() {  # WHAT COMMAND...
  "${@:2}" > /dev/null || { echo "demo: error: $1" >&2; exit 1; }
}
leaves "the headline does not name /player: $out/report.html" grep '<h2>.*/player' "$out/report.html"
leaves "the alarm left no flight record: $out/alarm_*.bag" \
  grep . <(find "$out" -maxdepth 1 -name 'alarm_*.bag' -newer "$out/monitor.yaml" -size +0)

say "What next"
echo "See who failed, when and why:  xdg-open $out/report.html"
echo "Learn your own robot:          source $workspace/devel/setup.bash &&" \
  "roslaunch self_awareness learn.launch hours:=2 model:=$HOME/robot.model"
echo "Read what to do with alarms:   $checkout/docs/alarm.md"

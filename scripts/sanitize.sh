#!/usr/bin/env bash
# Runs the C++ tests and the monitor under load with what finds errors in memory, undefined
# behaviour and races, and says how many tests passed.
#
# usage: scripts/sanitize.sh [address] [thread] [valgrind]     all three by default
#
#   address   AddressSanitizer, with leaks, and UndefinedBehaviorSanitizer
#   thread    ThreadSanitizer
#   valgrind  memcheck, on programs as they are otherwise built: their start and stop
#
# Each sanitizer builds in a workspace of its own, in the folder of its name in that of the checkout.
# What libraries do that are not ours is suppressed by name: test/sanitizers/*.supp.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

chosen=("$@")
[ $# -gt 0 ] || chosen=(address thread valgrind)
for tool in "${chosen[@]}"; do
  case $tool in
    address | thread | valgrind) ;;
    *)
      sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
done

install_packages
install_apt valgrind
build all talker  # the programs that the tests use, but for what is tested

use_loopback
tests=$checkout/test/sanitizers
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
export LSAN_OPTIONS=suppressions=$tests/leaks.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$tests/races.supp:second_deadlock_stack=1

main_workspace=$workspace
results=$main_workspace/sanitizer_results
rm -rf "$results"
programs=(self_awareness_node self_awareness_nodelet record_events)
live_gtests=(live_events discovery)  # under a master
rostest=$checkout/test/rostest       # what the live tests share

# run_gtests TOOL: those of the workspace that was built last
run_gtests() {
  local name bin=$workspace/devel/lib/self_awareness
  for name in "${gtests[@]}"; do
    say "$1: $name"
    unfinished "$1/$name"
    # What the tool reports at the end is in no result of a test: the exit code says it.
    "$bin/$name" --gtest_output="xml:$results/$1/$name.xml" > "$results/$1/$name.log" 2>&1 || {
      tail -n 100 "$results/$1/$name.log"
      unfinished "$1/$name.exit_code"
    }
  done
  for name in "${live_gtests[@]}"; do
    say "$1: $name"
    # Some of these tests look at the memory of the process: what was freed is soon reused.
    ASAN_OPTIONS=$ASAN_OPTIONS:quarantine_size_mb=1 ROS_TEST_RESULTS_DIR=$results/$1 \
      rostest "$checkout/test/$name.test" || true
  done
}

# run_monitor TOOL
run_monitor() (
  say "$1: the monitor with a robot"
  unfinished "$1/monitor"
  built_in=$workspace
  source_ros "$main_workspace/devel/setup.bash"
  SELF_AWARENESS_TOOL=$1 SELF_AWARENESS_BUILT_IN=$built_in PYTHONPATH=$rostest:$PYTHONPATH \
    /usr/bin/python3 -B -m pytest -q -p no:cacheprovider "$tests" \
    --junitxml="$results/$1/monitor.xml" || true
)

# unfinished RESULT: an empty file is a failure, until there are results
unfinished() {
  mkdir -p "$(dirname "$results/$1")"
  : > "$results/$1.xml"
}

# build_with FLAGS: our own code, not that of libraries; with the assertions of its headers
build_with() {
  build -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1 -fno-omit-frame-pointer $1" \
    "${programs[@]}" "${gtests[@]}" "${live_gtests[@]/%/_test}"
}

for tool in "${chosen[@]}"; do
  workspace=$main_workspace/$tool
  gtests=(core_test ros_test monitor_test)
  case $tool in
    address) build_with '-fsanitize=address,undefined -fno-sanitize-recover=all' ;;
    thread)
      gtests=(ros_test monitor_test)  # the core has no threads
      build_with -fsanitize=thread
      ;;
    valgrind) workspace=$main_workspace ;;
  esac
  [ "$tool" = valgrind ] || run_gtests "$tool"
  run_monitor "$tool"
done
exec /usr/bin/python3 "$checkout/test/count_results.py" "$results"

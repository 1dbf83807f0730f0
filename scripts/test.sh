#!/usr/bin/env bash
# Installs what the tests need, builds and runs them, and says how many passed, which were the
# slowest, and how long each stage took.
#
# usage: scripts/test.sh [quick]     quick: core, ros and monitor without a master, and Python
#                                    of what is called, not started

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

install_packages
results=$workspace/build/test_results
rm -rf "$results"

# run STAGE COMMAND... "|| true", because the results below tell.
run() {
  local begin=$SECONDS
  say "Testing: $1"
  "${@:2}" || true
  say_time "Testing: $1" "$begin"
}

# Nobody looks at a test with a debugger: what that needs takes a quarter of the time to compile. Most
# of the rest is for headers, which are read once for eight sources. That each source includes what it
# needs is seen in every other build; of the core's also below test/packaging.
options=(-DSELF_AWARENESS_WERROR=ON '-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O2 -DNDEBUG'
  -DCMAKE_UNITY_BUILD=ON)
if [ "${1:-}" = quick ]; then
  # The same options as in the whole: CMake does not run again, in the workspace's own environment.
  build "${options[@]}" all core_test ros_test monitor_test
  use_loopback
  mkdir -p "$results"
  for test in core_test ros_test monitor_test; do
    run $test "$workspace/devel/lib/self_awareness/$test" "--gtest_output=xml:$results/gtest-$test.xml"
  done
  run pytest /usr/bin/python3 -m pytest -q -p no:cacheprovider -n "$(nproc)" --dist loadfile \
    --junit-xml "$results/pytest-python.xml" \
    "$checkout"/test/python/{core,calibration,comparison,live_view,reporting,training}
  exec /usr/bin/python3 "$checkout/test/count_results.py" "$results" gtest pytest
fi
build "${options[@]}" all tests
use_loopback
# Two at once: so the last tests of one do not leave a processor idle.
for tests in gtest pytest roslaunch-check; do
  run $tests make -C "$workspace/build" "run_tests_self_awareness_$tests" -j2
done
# Live tests mostly wait.
run rostest make -C "$workspace/build" run_tests_self_awareness_rostest -j5

catkin_test_results --verbose "$results" || true
exec /usr/bin/python3 "$checkout/test/count_results.py" "$results" gtest pytest rostest

#!/usr/bin/env bash
# Installs what the tests need, builds and runs them all, and says how many passed.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

install_packages
# The same options both times: CMake does not run again, in the workspace's own environment.
build -DSELF_AWARENESS_WERROR=ON
build -DSELF_AWARENESS_WERROR=ON tests

use_loopback

say "Testing"
results=$workspace/build/test_results
rm -rf "$results"
# "|| true", because the results below tell.
for tests in gtest pytest roslaunch-check; do
  make -C "$workspace/build" "run_tests_self_awareness_$tests" -j1 || true
done
# Live tests mostly wait.
make -C "$workspace/build" run_tests_self_awareness_rostest -j3 || true

catkin_test_results --verbose "$results" || true
exec /usr/bin/python3 "$checkout/test/count_results.py" "$results" gtest pytest rostest

#!/usr/bin/env bash
# Kills each program that writes files TIMES times (100 by default), at random moments and while it
# writes, and looks whether anything is lost. scripts/test.sh does the same a few times.
#
# Usage: scripts/kill.sh [TIMES]

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

install_packages
build
build monitor_test

export SELF_AWARENESS_KILLS=${1:-100}
say "Killing each program $SELF_AWARENESS_KILLS times"
"$workspace/devel/lib/self_awareness/monitor_test" --gtest_filter='*Kill*'
cd "$checkout"
exec /usr/bin/python3 -B -m pytest -p no:cacheprovider -rP --durations=0 \
  test/python/test_killed_programs.py

#!/usr/bin/env bash
# The recovery beside the simulated robot at 10 times its speed: is a laser driver that hangs back
# within 5 s of the alarm, besides the delay, every time? Is a healthy node ever restarted? Writes a
# section of docs/reliability/README.md, and fails if not so.
#
# usage: scripts/recovery.sh [TIMES [MINUTES [OPTION...]]]     20 times, and 60 minutes of random
#                                                              faults by default
#
# Further options are those of `rosrun self_awareness evaluate recovery --help`. Run nothing else
# meanwhile.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

times=${1:-20}
minutes=${2:-60}
install_packages
build
say "Breaking a laser driver $times times, then anything for $minutes minutes"
cd "$checkout"
exec rosrun self_awareness evaluate recovery --times "$times" --minutes "$minutes" "${@:3}"

#!/usr/bin/env bash
# The monitor beside the simulated robot at 10 times its speed, with random faults: does it miss one,
# does it cry wolf, does its memory grow? Writes a section of docs/reliability/README.md, and fails
# if so.
#
# usage: scripts/soak.sh [MINUTES] [OPTION...]     60 minutes by default, and a quarter of an hour to
#                                                  learn before
#
# Further options are those of `rosrun self_awareness evaluate soak --help`. Run nothing else
# meanwhile.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

minutes=${1:-60}
install_packages
build
say "Soaking for $minutes minutes"
cd "$checkout"
exec rosrun self_awareness evaluate soak --minutes "$minutes" "${@:2}"

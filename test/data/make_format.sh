#!/usr/bin/env bash
# make_format.sh FOLDER: makes a small file of each kind by the programs whose setup.bash was
# sourced, and writes down what the model says: for the tests of the versions that follow.

set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
output=$(realpath "$1")
bags=$(mktemp -d)
trap 'rm -rf "$bags"' EXIT
mkdir -p "$output"
cd "$bags"

run() { rosrun self_awareness "$@"; }

/usr/bin/python3 "$here/make_bags.py" .
run train normal_[1-5].bag --detector both --jobs 1 -o robot.model
run calibrate --model robot.model --normal normal_6.bag -o robot.model
run calibrate --model robot.model --normal normal_6.bag --detector paper --cutoff fpr=0.001 \
  -o robot.model
for name in normal_6 dead late; do
  run convert "$name.bag" -o "$name.events.bag"
done
run score --model robot.model dead.events.bag late.events.bag --result-bag results.bag
/usr/bin/python3 "$here/says.py" robot.model normal_6.events.bag dead.events.bag late.events.bag \
  > expected.json
cp robot.model normal_6.events.bag dead.events.bag late.events.bag results.bag dead.graph.yaml \
  expected.json "$output"

#!/usr/bin/env bash
# Makes docs/report.png: the report of a dead node of the simulated robot, as a browser shows it.
# Installs the browser if it is missing.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

install_packages
build

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
cd "$folder"
export TZ=UTC
say "Making docs/report.png"
rosrun self_awareness simulate -o normal --runs 4 --duration 300 --seed 11
rosrun self_awareness simulate -o dead_laser.bag --duration 60 --seed 21 --fault crash:player@30
rosrun self_awareness train normal/normal_1[123].bag -o robot.model
rosrun self_awareness calibrate --model robot.model --normal normal/normal_14.bag -o robot.model
rosrun self_awareness score dead_laser.bag --model robot.model --report report.html
chromium --headless=new --no-sandbox --disable-gpu --hide-scrollbars --window-size=1200,980 \
  --virtual-time-budget=10000 --screenshot="$checkout/docs/report.png" "file://$folder/report.html"

#!/usr/bin/env bash
# The live tests among nodes that misbehave, at full length: test.sh runs the short form.
#
#     scripts/chaos.sh [UNLOADS] [TYPES]
#
# UNLOADS  how often the nodelet is unloaded and loaded again in one manager (default: 100)
# TYPES    messages with ever new values of a type field (default: 20000)

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

install_packages
build
build tests

use_loopback

exec rostest --text "$checkout/test/chaos.test" "unloads:=${1:-100}" "types:=${2:-20000}"

#!/usr/bin/env bash
# Runs a command with the libraries that the evaluation compares with, and installs those that are
# missing: scikit-learn from the distribution, hmmlearn, which Debian does not package, from PyPI
# into a virtual environment of its own. The package itself needs neither.
#
#   scripts/evaluation_env.sh rosrun self_awareness evaluate simulated
#
# SELF_AWARENESS_EVALUATION_ENV  the virtual environment
#                                (default: ~/.cache/self_awareness/evaluation)

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

environment=${SELF_AWARENESS_EVALUATION_ENV:-${XDG_CACHE_HOME:-$HOME/.cache}/self_awareness/evaluation}
hmmlearn=hmmlearn==0.3.2

install_apt python3-sklearn python3-venv
if ! "$environment/bin/python3" -c 'import hmmlearn' 2> /dev/null; then
  say "Installing $hmmlearn into $environment"
  /usr/bin/python3 -m venv --system-site-packages "$environment"
  # numpy, scipy and scikit-learn stay those of the distribution: the robot runs with them.
  "$environment/bin/pip" install --quiet --only-binary :all: "$hmmlearn"
fi

# The programs run with the system's Python; this makes it look here, too.
PYTHONPATH=${PYTHONPATH:+$PYTHONPATH:}$(
  "$environment/bin/python3" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
export PYTHONPATH
exec "$@"

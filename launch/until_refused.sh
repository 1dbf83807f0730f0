# The launch-prefix of nodes that are respawned: bash until_refused.sh NODE [ARGUMENT...]
#
# A node that ends with exit code 1 (an error) or 2 (wrong usage) has said why it cannot run.
# roslaunch would start it again with the same for ever, so this waits for its own end in its
# place. Any other end is handed on: a node that crashed is started again.

node=
# The first signal is handed on to the node alone; roslaunch sends it to both.
trap 'ending=1; [ -z "$node" ] || kill -INT "$node" 2> /dev/null' INT
trap 'ending=1; [ -z "$node" ] || kill -TERM "$node" 2> /dev/null' TERM

(
  trap - INT TERM  # in the background, it would be deaf to SIGINT
  exec "$@"
) &
node=$!
wait "$node"
code=$?
while [ -n "$ending" ] && kill -0 "$node" 2> /dev/null; do  # the signal ended only the wait
  wait "$node"
  code=$?
done
trap - INT TERM  # from here on, a signal ends this at once
if [ -n "$ending" ] || { [ "$code" -ne 1 ] && [ "$code" -ne 2 ]; }; then
  exit "$code"
fi
echo "${1##*/}: waiting for the end: launch it again with other arguments or parameters" >&2
exec sleep infinity

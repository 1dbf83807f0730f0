# The launch-prefix of nodes that are respawned: bash until_refused.sh NODE [ARGUMENT...]
#
# A node that ends with exit code 1 (an error) or 2 (wrong usage) has said why it cannot run.
# roslaunch would start it again with the same for ever, so this waits for its own end in its
# place. Any other end is handed on: a node that crashed is started again.

node=
# The first signal is handed on to the node alone; roslaunch sends it to both.
hand_on() {
  ending=$1
  if [ -n "$node" ]; then
    handed_on=1
    kill "-$1" "$node" 2> /dev/null
  fi
}
trap 'hand_on INT' INT
trap 'hand_on TERM' TERM

(
  trap - INT TERM  # in the background, it would be deaf to SIGINT
  exec "$@"
) &
node=$!
if [ -n "$ending" ] && [ -z "$handed_on" ]; then  # it came before the node was known
  kill "-$ending" "$node" 2> /dev/null
fi
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
name=${1##*/}
for word; do
  [[ $word != __name:=* ]] || name=${word#*:=}
done
echo "$name cannot run (see above), and is not started again: end roslaunch, correct that, launch it again" >&2
# Not by a program: a signal that comes while bash gives its place to one would be lost.
exec {nothing}<> <(:)
read -r -u "$nothing"

# Sourced by demo.sh: the progress of a build, and processes in the background, each with its log in the folder $out. If one of
# them ends by itself, its last lines are shown at once, and the script ends.

started=()  # log by process id

start() {  # LOG COMMAND...
  local log=$1
  shift
  setsid "$@" > "$out/$log" 2>&1 < /dev/null &
  started[$!]=$log
}

# Ends all that runs in the background, and kills what is left of it after 10 s. By SIGTERM: a script
# lets what it puts in the background ignore SIGINT.
stop_all() {
  local pid
  for pid in $(jobs -p); do
    [ -n "${started[$pid]:-}" ] || stop "$pid" "$pid"
  done
  for pid in "${!started[@]}"; do stop "$pid" "-$pid"; done
}

# One that was forked a moment ago leads no group yet, and still has the handlers of this shell, which
# forget the signal when it becomes another program. So a group gets it when there is one, and a
# process once more every second.
stop() {  # PID PID|-GROUP
  local pid=$1 target=$2 tenths sent=
  for ((tenths = 0; tenths < 100; ++tenths)); do
    if [ "$target" = "$pid" ]; then
      [ $((tenths % 10)) -gt 0 ] || sent=
    elif [ -n "$sent" ]; then
      kill -0 -- "$target" 2> /dev/null || break
    fi
    [ -n "$sent" ] || ! kill -- "$target" 2> /dev/null || sent=yes
    kill -0 "$pid" 2> /dev/null || kill -0 -- "$target" 2> /dev/null || break
    sleep 0.1
  done
  kill -KILL -- "$target" 2> /dev/null || true
  wait "$pid" 2> /dev/null || true
}

# Shows how far a build is, in steps of 5 %, by the output of make; and how long it took.
progress_of_make() {
  local line next=0
  while read -r line; do
    if [[ $line =~ ^\[\ *([0-9]+)%\] ]] && [ "${BASH_REMATCH[1]}" -ge "$next" ]; then
      echo "${BASH_REMATCH[1]} % built"
      next=$((BASH_REMATCH[1] - BASH_REMATCH[1] % 5 + 5))
    elif [[ $line =~ ^Building\ took\  ]]; then
      echo "$line"
    fi
  done
}

fail_with_log() {  # LOG WHAT
  echo "demo: error: $2; the end of $out/$1:" >&2
  tail -n 20 "$out/$1" >&2
  exit 1
}

check_started() {
  local pid
  for pid in "${!started[@]}"; do
    kill -0 "$pid" 2> /dev/null || fail_with_log "${started[$pid]}" "a process ended by itself"
  done
}

await() {  # SECONDS DESCRIPTION COMMAND...
  local seconds=$1 description=$2 deadline=$((SECONDS + $1))
  shift 2
  until "$@" > /dev/null 2>&1; do
    check_started
    if [ $SECONDS -ge $deadline ]; then
      echo "demo: error: not within $seconds s: $description; see $out/*.log" >&2
      exit 1
    fi
    sleep 0.2
  done
}

# Waits for a process of this shell that was not started by start(); returns its exit code.
watch() {  # PID
  while kill -0 "$1" 2> /dev/null; do
    check_started
    sleep 0.2
  done
  wait "$1"
}

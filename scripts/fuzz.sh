#!/usr/bin/env bash
# fuzz.sh [SECONDS]: lets libFuzzer look for input that crashes, hangs or bloats what reads bags,
# event logs, models, standing alarms, messages and encodings. Each fuzzer runs that long (default: 60),
# as many at once as there are processors. It ends with an error if one finds something, and says where
# the input lies.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

seconds=${1:-60}
workspace=$workspace/fuzz  # a build of its own, by another compiler
found=$workspace/found

install_packages
install_apt clang-14 libclang-rt-14-dev

say "Building with clang"
mkdir -p "$workspace/build" "$found"
# What libFuzzer wants to see, and what ends the program at the first error. "vptr" and "function"
# would need the same of all libraries.
flags="-O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize=vptr,function"
flags="$flags -fno-sanitize-recover=all"
cmake -S "$checkout" -B "$workspace/build" -DPYTHON_EXECUTABLE=/usr/bin/python3 \
  -DCMAKE_CXX_COMPILER=clang++-14 -DCMAKE_C_COMPILER=clang-14 -DCMAKE_CXX_FLAGS="$flags" \
  -DCMAKE_BUILD_TYPE=None -DCATKIN_ENABLE_TESTING=OFF -DSELF_AWARENESS_FUZZ=ON \
  -DCATKIN_DEVEL_PREFIX="$workspace/devel" > "$workspace/cmake.log"
make -C "$workspace/build" -j"$(nproc)" fuzzers

programs=$workspace/devel/lib/self_awareness
seeds=$workspace/seeds
rm -rf "$seeds"
"$programs/fuzz_seeds" "$seeds"

export LSAN_OPTIONS=suppressions=$checkout/test/sanitizers/leaks.supp:print_suppressions=0

# fuzz CORPUS: for its time; what the fuzzer prints is in a log, and shown where it found something.
fuzz() {
  local corpus=$1
  local log=$workspace/$corpus.log
  mkdir -p "$workspace/corpus/$corpus"
  # The largest allocation is a chunk of a bag that is unpacked; 10 s are a hang.
  if ! "$programs/fuzz_$corpus" -max_total_time="$seconds" -timeout=10 -malloc_limit_mb=1100 \
      -rss_limit_mb=3000 -max_len=65536 -print_final_stats=1 -print_funcs=0 -verbosity=0 \
      -artifact_prefix="$found/$corpus-" "$workspace/corpus/$corpus" "$seeds/$corpus" > "$log" 2>&1; then
    tail -n 100 "$log"
    echo "$corpus: found something, see $found"
    return 1
  fi
  echo "$corpus: nothing found in $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") runs"
}
export -f fuzz
export workspace programs seeds found seconds

say "Fuzzing, $seconds s each, as many at once as there are processors"
printf '%s\n' message_field message_upgrade encoding bag event_log model standing_alarm |
  xargs --max-procs="$(nproc)" -I CORPUS bash -c 'fuzz CORPUS'

#!/usr/bin/env bash
# Compiles the core with its tests and examples for 64-bit ARM, runs them in an emulator, and says
# how many passed. Installs the compiler and the emulator if they are missing.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

install_apt cmake make g++-aarch64-linux-gnu qemu-user-static googletest libeigen3-dev nlohmann-json3-dev

folder=$workspace/aarch64
prefix=$folder/prefix
results=$folder/results
mkdir -p "$prefix"
rm -rf "$results"
cross=(
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64
  -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++
  -DCMAKE_EXE_LINKER_FLAGS=-static -DCMAKE_CROSSCOMPILING_EMULATOR=/usr/bin/qemu-aarch64-static
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_PREFIX_PATH="$prefix"
)

say "Building for aarch64 in $folder"
cmake -S /usr/src/googletest -B "$folder/googletest" "${cross[@]}" \
  -DBUILD_GMOCK=OFF -DCMAKE_INSTALL_PREFIX="$prefix" > "$folder/googletest.log"
make -C "$folder/googletest" -j"$(nproc)" install >> "$folder/googletest.log"
# The package has only headers, but they lie in /usr/include beside those for this machine's
# processor: they need a folder of their own.
dpkg --listfiles nlohmann-json3-dev | sed 's,^/,,' |
  tar --create --directory / --no-recursion --files-from - |
  tar --extract --directory "$prefix" --strip-components 1
cmake -S "$checkout/src/core" -B "$folder/core" "${cross[@]}" -DCMAKE_CXX_FLAGS=-Werror
make -C "$folder/core" -j"$(nproc)"

say "Testing"
(cd "$folder/core" && GTEST_OUTPUT=xml:$results/core_test.xml ctest --output-on-failure)
exec /usr/bin/python3 "$checkout/test/count_results.py" "$results"

#!/usr/bin/env bash
# Runs the linters, and says which of them found something.
#
# usage: scripts/lint.sh [CHECK...]     all of these by default, but clang-tidy-core, a part of the last
#
#   catkin_lint      package.xml and every CMakeLists.txt
#   clang-format     C++, by .clang-format
#   flake8           Python, by setup.cfg
#   mypy             the types in Python, by setup.cfg
#   clang-tidy-core  the C++ of the core, by .clang-tidy, without a build
#   clang-tidy       all C++ that is in the build, by .clang-tidy (10 minutes on two cores)
#
# Without a CHECK, it first installs what is missing, and prepares the build. With one, it needs no
# network; so do the tests (test/python/test_lint.py) and the hooks of .pre-commit-config.yaml.
#
# SELF_AWARENESS_BUILD  the build whose compile_commands.json clang-tidy reads; by default that of
#                       scripts/test.sh
#
# Exit code 0 only if nothing was found; 3 if a CHECK cannot run, and says why.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

python=/usr/bin/python3
# Tests and benchmarks take for granted what they have just set up, and fail by themselves where it
# is None, or no more than what a base class says.
lenient=(--no-strict-optional --disable-error-code=override --disable-error-code=union-attr
  --disable-error-code=var-annotated)

cannot() {
  echo "not checked: $*"
  exit 3
}

# needs VERSION PROGRAM...: where linters of other versions say other things; '' where any will do
needs() {
  local version
  version=$("${@:2}" --version 2>&1) || cannot "${*:2} is not installed"
  [[ " ${version//$'\n'/ }" == *" $1"* ]] || cannot "it needs version $1, this is $version"
}

cpp_files() { find benchmark examples include src test -name '*.h' -o -name '*.cpp' | sort; }

# Programs have no extension that tells their language.
python_programs() { grep -l '^#!/usr/bin/python3' nodes/* scripts/*; }

# What is in the build.
tidy() {
  needs 14. clang-tidy
  local build=${SELF_AWARENESS_BUILD:-$workspace/build} sources folder status=0
  [ -e "$build/compile_commands.json" ] || cannot "there is no build in $build"
  folder=$(mktemp -d)
  # Headers that g++ has compiled before are none for clang.
  sed 's/-include [^ ]*cmake_pch.hxx//' "$build/compile_commands.json" > "$folder/compile_commands.json"
  sources=$(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$folder/compile_commands.json" |
    grep -v '/cmake_pch\.hxx' | sort -u)
  # There is no .clang-tidy beside what scripts/test.sh has compiled: files in the build that include
  # sources.
  xargs --max-procs "$(nproc)" --max-args 1 clang-tidy --quiet --config-file=.clang-tidy \
    -p "$folder" <<< "$sources" 2>&1 | without_numbers || status=1
  rm -r "$folder"
  return "$status"
}

# A header takes more time than what includes it: one file includes all sources of the core. So no two
# of them may use one name in a namespace without a name: clang-tidy says which do, as an error.
tidy_core() {
  needs 14. clang-tidy
  local folder status=0
  folder=$(mktemp -d)
  find "$checkout/src/core" -name '*.cpp' | sort |
    sed 's|.*|#include "&"|' > "$folder/core.cpp"
  clang-tidy --quiet --config-file=.clang-tidy "$folder/core.cpp" -- -std=c++17 -I"$checkout/include" \
    -I"$checkout/src" -isystem /usr/include/eigen3 2>&1 | without_numbers || status=1
  rm -r "$folder"
  return "$status"
}

# The number of warnings in headers of others, for each file, tells nothing.
without_numbers() { grep -v '^[0-9]* warnings\{0,1\} .*generated\.$' || true; }

check() {
  case $1 in
    catkin_lint)
      needs '' catkin_lint
      catkin_lint -W1 --strict "$checkout"
      ;;
    clang-format)
      needs 14. clang-format
      cpp_files | xargs clang-format --dry-run -Werror
      ;;
    flake8)
      needs '' "$python" -m flake8
      python_programs | xargs "$python" -m flake8 benchmark setup.py src test
      ;;
    mypy)
      needs 1. "$python" -m mypy
      mkdir -p "$workspace"
      python_programs | xargs "$python" -m mypy --cache-dir "$workspace/mypy" src
      "$python" -m mypy --cache-dir "$workspace/mypy_tests" "${lenient[@]}" benchmark \
        test/count_results.py test/data test/python test/rostest test/sanitizers
      ;;
    clang-tidy-core) tidy_core ;;
    clang-tidy) tidy ;;
    *)
      sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
}

cd "$checkout"
if [ $# -eq 1 ]; then
  check "$1"
  exit
fi
checks=("$@")
if [ $# -eq 0 ]; then
  checks=(catkin_lint clang-format flake8 mypy clang-tidy)
  install_packages
  build self_awareness_generate_messages_cpp  # what the sources include
fi
found=()
for name in "${checks[@]}"; do
  say "$name"
  "$checkout/scripts/lint.sh" "$name" || found+=("$name")
done
[ ${#found[@]} -eq 0 ] || { say "Not clean: ${found[*]}"; exit 1; }
say "Clean: ${checks[*]}"

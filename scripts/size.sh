#!/usr/bin/env bash
# Counts what whoever picks this up has to carry: lines by part, messages with their fields, numbers
# of the method, pages and their words. Only what is committed counts.
#
#   scripts/size.sh [COMMIT]

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
commit=${1:-HEAD}
source='\.(cpp|h|py)$'

files() {  # INCLUDE [EXCLUDE]: regular expressions of paths
  git ls-tree -r --name-only "$commit" | grep -E "$1" | grep -Ev "${2:-^$}" || true
}

lines() {  # as files()
  files "$@" | grep -E "$source" | xargs git grep -c '' "$commit" -- |
    awk -F: '{ sum += $NF } END { print sum }'
}

row() { printf '%-46s %8s\n' "$1" "$2"; }

row 'product, without evaluation and benchmark' "$(lines . \
  '^(test|benchmark|src/self_awareness_evaluation)/')"
row '  the core' "$(lines '^(src|include/self_awareness)/core/')"
row '  of it core/evidence' "$(lines '^(src|include/self_awareness)/core/evidence/')"
row '  ros' "$(lines '^(src|include/self_awareness)/ros/')"
row '  the nodes' "$(lines '^src/(monitor|node|recorder)/')"
row '  Python, with the bindings' "$(lines '^src/(python|self_awareness|self_awareness_follow_me)/')"
row 'evaluation' "$(lines '^src/self_awareness_evaluation/')"
row 'benchmark' "$(lines '^benchmark/')"
row 'tests' "$(lines '^test/')"
row 'messages and services' "$(files '\.(msg|srv)$' | wc -l)"
row '  their fields' "$(files '\.(msg|srv)$' |
  xargs git grep -hE '^[a-zA-Z][a-zA-Z0-9_/]*(\[[0-9]*\])? +[a-z][a-z0-9_]*( |$)' "$commit" -- | wc -l)"
row 'numbers in Tuning' "$(git show "$commit:include/self_awareness/core/evidence/tuning.h" |
  sed '/^};/q' | grep -cE '^  double [a-z_]+ = ')"
row 'pages' "$(files '(^README|^docs/.*)\.md$' | wc -l)"
row '  their words' "$(files '(^README|^docs/.*)\.md$' | xargs git grep -h '' "$commit" -- | wc -w)"

#!/usr/bin/env bash
# Writes pages in HTML about the headers that docs/library.md names: start at index.html. Installs
# doxygen if it is missing.
#
# usage: scripts/api_docs.sh FOLDER
#        scripts/api_docs.sh --headers    only says which headers these are
#
# Exit code 0 only if doxygen warned of nothing, such as a class without a comment.

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

case ${1:-} in
  '' | --help)
    sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac

headers=$(grep --only-matching '`core/[a-z_/]*\.h`' "$checkout/docs/library.md" | tr -d '`' |
  sort -u | sed 's,^,include/self_awareness/,')
if [ "$1" = --headers ]; then
  echo "$headers"
  exit
fi

install_apt doxygen
mkdir -p "$1"
folder=$(cd "$1" && pwd)
cd "$checkout"
# Links to other pages lead nowhere from there: their words stay.
doxygen - << SETTINGS
PROJECT_NAME           = self_awareness
PROJECT_BRIEF          = "The core as a C++ library"
INPUT                  = docs/library.md ${headers//$'\n'/ }
USE_MDFILE_AS_MAINPAGE = docs/library.md
STRIP_FROM_INC_PATH    = include
STRIP_FROM_PATH        = include
FILTER_PATTERNS        = "*.md=sed -E 's/\[([^]]*)\]\([^)]*\)/\1/g'"
OUTPUT_DIRECTORY       = "$folder"
HTML_OUTPUT            = .
GENERATE_LATEX         = NO
HAVE_DOT               = NO
JAVADOC_AUTOBRIEF      = YES
EXTRACT_STATIC         = YES
SORT_MEMBER_DOCS       = NO
QUIET                  = YES
WARN_IF_INCOMPLETE_DOC = NO
WARN_AS_ERROR          = FAIL_ON_WARNINGS
SETTINGS
say "See $folder/index.html"

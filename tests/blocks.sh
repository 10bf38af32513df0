#!/bin/sh
# blocks.sh - the fenced blocks of a page, for tests and for `make gallery`
#
#     blocks.sh KIND PAGE [HEADING]
#
# prints the lines of all blocks ```KIND in the sections whose heading, a line
# with two #, has the extended regular expression HEADING in it: of the whole
# page where none is given.  Fails where there is no such block.
set -eu
awk -v kind="$1" -v heading="${3:-}" '
    /^```/ { inside = !inside; wanted = inside && section && $0 == "```" kind
             next }
    NR == 1 { section = heading == "" }
    !inside && /^## / { section = heading == "" || $0 ~ heading }
    wanted { print; found = 1 }
    END { exit !found }' "$2"

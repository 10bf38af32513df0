#!/bin/sh
# layers.sh - includes go one way: bsdf <- validate <- plots, integrator
#
# A folder may include from itself and from those to the left of it; tests/ may
# include from all.  Prints each include that goes against that and fails.
set -u
bad=0
allowed() {
    case $1 in
    bsdf) echo "bsdf" ;;
    validate) echo "bsdf validate" ;;
    plots) echo "bsdf validate plots" ;;
    integrator) echo "bsdf validate integrator" ;;
    esac
}
for folder in bsdf validate plots integrator; do
    [ -d "$folder" ] || continue
    for file in "$folder"/*.[ch]; do
        for target in $(sed -n 's/^#include "\([a-z]*\)\/.*/\1/p' "$file" | sort -u); do
            case " $(allowed "$folder") " in
            *" $target "*) ;;
            *) echo "$file includes from $target/, which $folder/ may not" >&2
               bad=1 ;;
            esac
        done
        # Paths start at the root.
        if grep -n '^#include "[^/]*"' "$file" >&2; then
            echo "$file: write the include from the root, as in \"bsdf/vec.h\"" >&2
            bad=1
        fi
    done
done
[ $bad = 0 ] && echo "layers: every include goes the right way"
exit $bad

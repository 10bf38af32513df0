#!/bin/sh
# mutate_tester.sh - mistakes in the checks themselves: a test must notice each
#
# usage: mutate_tester.sh FOLDER JOBS [WORD], in the root of the sources; with
# WORD, only the mistakes whose line has it
#
# The sources are copied to FOLDER; there each mistake below is made alone, by
# one sed script, and the tests that it names are built and run until one fails.
# A script that changes nothing is an error, so that none goes stale unseen; so
# is a mistake that does not compile, or a test that fails without any.
#
# Exit status: 0 all were noticed; 1 one was not; 2 it could not be tried.
set -u

# name | file | tests, the likely one first | sed script
mistakes() {
    cat <<'END'
significance 0|validate/run.c|test_statistics|s/level = significance \//level = 0 * significance \//
significance 0 by default|validate/subject.c|test_checks|s/\.significance = 1e-6/.significance = 0/
a level an integer|validate/run.c|test_statistics|s/^\( *\)double level = /\1int level = (int)/
the pools are dropped|validate/check_chi2.c|test_decisions|s/cell_add(&o\.pool\[[^;]*;/(void)pool_apart_below;/
the emptiest pool is dropped|validate/check_chi2.c|test_decisions|s/cell_add(&o\.pool\[expected >= pool_apart_below\], c);/if (expected >= pool_apart_below) cell_add(\&o.pool[1], c);/
pooled cells are never the worst|validate/check_chi2.c|test_decisions|s/if (!(fabs(r) > 2))/if (!(fabs(r) > 2) || cell[i].share.value * (double)samples < pool_below)/
cells are chosen by what was observed|validate/check_chi2.c|test_decisions|s/^\( *\)if (expected < pool_below)$/\1if (c.count == 0) continue;\n&/
expectations are rescaled|validate/check_chi2.c|test_decisions|s/const struct cell c = above_0(cell\[i\]);/struct cell c = above_0(cell[i]); c.share.value *= i + 1 < n ? 1 - (double)cell[n - 1].count \/ (double)samples : 0;/
refused samples are left out|validate/check_chi2.c|test_decisions|s/survey_refusal(v), v->refused/{ 0, 0 }, 0/
the error of integration is ignored|validate/check_chi2.c|test_decisions|s/fmax(fabs(off) - c\.share\.error \* samples, 0)/fabs(off)/
the error is ignored by tails|validate/pvalue.c|test_statistics|s/q\.value - q\.error, high = q\.value + q\.error/q.value, high = q.value/
pilots and survey share a seed|validate/survey.c|test_decisions|s/STREAM_PILOT)/STREAM_SURVEY)/
the best p swallows a NaN|validate/pvalue.c|test_statistics|s/isnan(p\[i\]) || //
a tail swallows a NaN|validate/pvalue.c|test_statistics test_decisions|s/!(p >= pvalue_impossible)/p < pvalue_impossible/
a verdict swallows a NaN|validate/checks.c|test_checks|s/v\.value - v\.error <= v\.limit/!(v.value - v.error > v.limit)/
finite swallows a NaN|validate/check_finite.c|test_checks|s/return isfinite(x) \&\& x >= 0;/return !(x < 0);/
sample swallows a NaN|validate/check_sample.c|test_checks|s/ \&\& !isnan(off))/)/
reciprocity swallows a NaN|validate/check_reciprocity.c|test_checks|s/ \&\& !isnan(x + y))/)/; s/ \&\& !isnan(off))/)/
energy swallows a NaN|validate/check_energy.c|test_checks|s/isnan(albedo\.value) || //; s/if (!(albedo\.error <= v->error))/if (albedo.error > v->error)/; s/if (!(e->unsampled\.value - e->unsampled\.error <= error_limit))/if (e->unsampled.value - e->unsampled.error > error_limit)/
stray samples are forgotten|validate/check_chi2.c|test_decisions|s/survey->stray > 0 || /0 || /
ridges are not followed|validate/quadrature.c|test_masses|s/ \&\& follow(&w);/;/
hints of a quadrature are forgotten|validate/quadrature.c|test_masses|s/if (l->hint\[i\]\.height > least)/if (l->hint[i].height > INFINITY)/
Bonferroni is forgotten|validate/run.c|test_statistics|s/significance \/ (double)(n - i)/significance/
END
}

folder=${1:?folder} jobs=${2:?jobs} word=${3:-}
here=$(pwd)
tests=$(mistakes | grep -F "$word" | cut -d'|' -f3 | tr ' ' '\n' | sort -u)

mkdir -p "$folder" || exit 2
folder=$(cd "$folder" && pwd) || exit 2
[ -n "$tests" ] || { echo "no mistake has \"$word\" in its line" >&2; exit 2; }

# The sources as they are now; what was built of those of the last time stays.
for old in "$folder"/*; do
    [ "$old" = "$folder/build" ] || rm -rf "$old"
done
(cd "$here" && tar -cf - --exclude=./build --exclude=./.git .) |
    tar -xf - -C "$folder" || exit 2
cd "$folder" || exit 2
# Of the last time some may have been made of a mistake.
mistakes | cut -d'|' -f2 | sort -u | while read -r file; do
    rm -f "build/obj/${file%.c}.o"
done

# Builds tests; what the compiler said is shown only where it fails.
build() {
    targets=
    for t in "$@"; do targets="$targets build/bin/tests/$t"; done
    # shellcheck disable=SC2086 # one word a target
    make config=release -j"$jobs" $targets >build/log 2>&1 ||
        { tail -n 20 build/log >&2; return 1; }
}

# Runs tests until one fails; 0 where one did, and its name in noticed.
fails() {
    for t in "$@"; do
        BIN=build/bin "build/bin/tests/$t" >build/log 2>&1 ||
            { noticed=$t; return 0; }
    done
    return 1
}

mkdir -p build
# shellcheck disable=SC2086 # names without spaces
{
    build $tests || { echo "the tests do not build without a mistake" >&2; exit 2; }
    if fails $tests; then
        tail -n 20 build/log >&2
        echo "$noticed fails without a mistake" >&2
        exit 2
    fi
}

mistakes | grep -F "$word" >build/mistakes
all=0 missed=0 broken=0
while IFS='|' read -r name file names script <&3; do
    all=$((all + 1))
    if ! cp "$file" build/whole || ! sed "$script" build/whole >"$file"; then
        echo "STALE     $name: $file cannot be changed"
        broken=$((broken + 1))
        continue
    fi
    if cmp -s "$file" build/whole; then
        echo "STALE     $name: the script changes nothing in $file"
        broken=$((broken + 1))
    elif ! build $names; then
        echo "STALE     $name: $file does not compile"
        broken=$((broken + 1))
    elif fails $names; then
        echo "noticed   $name: by $noticed"
    else
        echo "MISSED    $name: $names"
        missed=$((missed + 1))
    fi
    cat build/whole >"$file" # with a new date, so that it is built again
done 3<build/mistakes

echo "$all mistakes of the checks, $((all - missed - broken)) noticed, $missed missed, $broken could not be tried"
[ "$broken" = 0 ] || exit 2
[ "$missed" = 0 ] || exit 1

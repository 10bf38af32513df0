#!/bin/sh
# course.sh - the course's scenes against pictures that others made of them
#
#     sh tests/course.sh BIN SHARED FOLDER [FAST]
#
# Renders into FOLDER the scenes of SHARED/data/cs184 with their faults and flags,
# compares with the pictures beside them, and prints for each the median ratio of
# blocks and their correlation.  With FAST fewer samples, and M = 1 and 3 only.
# Fails where a picture by the same program and flags (peer) is off by more than
# 2 % in the median, or correlates by less than .99.
set -u
bin=$1 scenes=$2/data/cs184 out=$3 fast=${4:-}
pictures=$scenes/reference_png
samples=64
[ -z "$fast" ] || samples=16
mkdir -p "$out"
bad=0

# render NAME SCENE FLAGS...
render() {
    name=$1 scene=$2
    shift 2
    "$bin/bsdf-render" "$scenes/$scene" --compat course --rgb fixed:614,549,466 \
        -r 480 360 -f "$out/$name.png" "$@" 2>"$out/$name.txt" >/dev/null ||
        { cat "$out/$name.txt" >&2; exit 2; }
}

# against NAME PICTURE [must]
against() {
    said=$("$bin/bsdf-render" --compare "$pictures/$2.png" "$out/$1.png") || exit 2
    ratio=$(echo "$said" | sed -n 's/.*median \([0-9.]*\),.*/\1/p')
    alike=$(echo "$said" | sed -n 's/correlation \([0-9.]*\)/\1/p')
    verdict=
    if [ -n "${3:-}" ]; then
        verdict=$(awk -v r="$ratio" -v c="$alike" \
            'BEGIN { print (r > .98 && r < 1.02 && c > .99) ? "ok" : "FAILS" }')
        [ "$verdict" = ok ] || bad=1
    fi
    printf '%-26s %-44s %7s %8s %s\n' "$1" "$2" "$ratio" "$alike" "$verdict"
}

printf '%-26s %-44s %7s %8s\n' rendered picture ratio alike
depths="0 1 3 5"
[ -z "$fast" ] || depths="1 3"
for m in $depths; do
    render "spheres_m$m" CBspheres.dae -s $samples -l 1 -m "$m" -a 32 0.05
    against "spheres_m$m" "peer_CBspheres_s64_l1_m$m" must
    against "spheres_m$m" "student_sp22_CBspheres_s256_m$m"
done
if [ -z "$fast" ]; then
    render spheres_m5_fixed CBspheres.dae -s 64 -l 1 -m 5
    against spheres_m5_fixed peer_CBspheres_s64_l1_m5_fixed must
    render spheres_m5_light CBspheres.dae -s 64 -l 1 -m 5 \
        --compat camera,tone,light-quad,schlick,refraction
    against spheres_m5_light student_sp19_CBspheres_m5
    for alpha in 0.005 0.25; do
        xz -dc "$scenes/CBdragon_microfacet_au.dae.xz" |
            sed "s|<alpha>[^<]*</alpha>|<alpha>$alpha</alpha>|" >"$out/dragon.dae"
        "$bin/bsdf-render" "$out/dragon.dae" --compat course \
            -s 128 -l 1 -m 5 -r 480 360 -f "$out/dragon_$alpha.png" \
            2>"$out/dragon_$alpha.txt" >/dev/null || exit 2
        against "dragon_$alpha" "student_sp20_CBdragon_au_alpha$alpha"
    done
    rm -f "$out/dragon.dae"
    render bunny CBbunny_microfacet_cu.dae -s 64 -l 1 -m 5
    against bunny student_sp20_CBbunny_cu_cosine_hemisphere
fi
exit $bad

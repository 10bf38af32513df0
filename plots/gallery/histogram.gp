reset
set encoding utf8
set angles degrees
table = "./histogram" . ".tsv"
if (!exists("picture")) picture = "./histogram" . ".svg"
degree = "°"
set terminal svg size 800,464 noenhanced font "sans-serif,12" linewidth 1 background "#ffffff"
set output picture
if (exists("window")) { set output; eval("set terminal " . window) }
set linetype 1 lc rgb "#D55E00" dt 1 lw 2.2
set linetype 2 lc rgb "#009E73" dt (12,7) lw 2
set linetype 3 lc rgb "#0072B2" dt (3,4) lw 2.2
set linetype 4 lc rgb "#CC79A7" dt (12,4,3,4) lw 1.8
set linetype 5 lc rgb "#E69F00" dt (12,4,3,4,3,4) lw 1.8
set linetype 6 lc rgb "#56B4E9" dt (6,3) lw 1.8
set linetype 7 lc rgb "#000000" dt (18,4) lw 1.5
set linetype 8 lc rgb "#808080" dt (2,5) lw 2
set linetype 9 lc rgb "#303030" dt 1 lw 2.2
set linetype 10 lc rgb "#606060" dt (14,9) lw 1
set linetype 11 lc rgb "#b8b8b8" dt 1 lw 0.5
heat = 'defined (0 "#440154", 1 "#482878", 2 "#3e4a89", 3 "#31688e", 4 "#26828e", 5 "#1f9e89", 6 "#35b779", 7 "#6dcd59", 8 "#b4de2c", 9 "#fde725")'
sigma = 'defined (0 "#00224e", 1 "#123570", 2 "#3b496c", 3 "#575d6d", 4 "#707173", 5 "#8a8779", 6 "#a69d75", 7 "#c4b56c", 8 "#e4cf5b", 9 "#fee838")'
set multiplot

set label "roughconductor:material=Ca,alpha=0.25" at screen 0.5,0.963362 center noenhanced
set label "ωₒ: θ = 45°, φ = 0°;  R, G, B (fit);  1000000 samples, seed 1" at screen 0.5,0.924569 center noenhanced
set label "θ: angle of ωᵢ to the normal; φ′: its azimuth from that of the mirror direction; cross: mirror direction of ωₒ" at screen 0.5,0.12069 center noenhanced
set label "In the window: 99.32% of the samples, 99.31% expected; refused: 0.623%" at screen 0.5,0.0840517 center noenhanced
set label "O observed, E expected in a cell; residual left blank where E < 5: there O = 748, E = 715.44 in all" at screen 0.5,0.0474138 center noenhanced
set parametric; set trange [0:360]; set samples 361
set colorbox horizontal user origin screen 0.09,0.24569 size screen 0.56625,0.0237069 border
set cbtics  scale 0.5 0.2 format "%.10g"
set label "density [1/sr]" at screen 0.373125,0.172414 center noenhanced
set object ellipse center 0,0 size 180,180 units xy behind fillcolor rgb "#d9d9d9" fillstyle solid 1 noborder
set label "" at 45,0 point pt 1 ps 0.9 lc rgb "#ffffff" lw 1.2 front

# samples
set lmargin at screen 0.09; set rmargin at screen 0.355
set bmargin at screen 0.387931; set tmargin at screen 0.844828
unset key; set border 15 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-16.6111022812:90.0000106611]
set xtics autofreq 30 nomirror out scale 0.7,0.4 format "%.10g"
unset logscale y; set yrange [-53.3866742263:53.224438716]
set ytics autofreq 30 nomirror out scale 0.7,0.4 format "%.10g"
set label "samples" at screen 0.2225,0.875 center
set label "θ cos φ′ [deg]" at screen 0.2225,0.306034 center
set label "θ sin φ′ [deg]" at screen 0.0175,0.616379 center rotate by 90
set palette @heat
unset logscale cb; set cbrange [0:1.853943218]
plot table index 0 using ($1):($2):($7/1e0) with image pixels notitle, \
     30*cos(t),30*sin(t) with lines lc rgb "#c0c0c0" dt 1 lw 0.5 notitle, \
     60*cos(t),60*sin(t) with lines lc rgb "#c0c0c0" dt 1 lw 0.5 notitle, \
     90*cos(t),90*sin(t) with lines lc rgb "#404040" dt 1 lw 1 notitle
unset arrow; unset label; unset colorbox
unset object
set object ellipse center 0,0 size 180,180 units xy behind fillcolor rgb "#d9d9d9" fillstyle solid 1 noborder
set label "" at 45,0 point pt 1 ps 0.9 lc rgb "#ffffff" lw 1.2 front

# pdf, integrated over each cell
set lmargin at screen 0.39125; set rmargin at screen 0.65625
set bmargin at screen 0.387931; set tmargin at screen 0.844828
unset key; set border 15 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-16.6111022812:90.0000106611]
set xtics autofreq 30 nomirror out scale 0.7,0.4 format "%.10g"
unset logscale y; set yrange [-53.3866742263:53.224438716]
set ytics autofreq 30 nomirror out scale 0.7,0.4 format ""
set label "pdf, integrated over each cell" at screen 0.52375,0.875 center
set label "θ cos φ′ [deg]" at screen 0.52375,0.306034 center
set palette @heat
unset logscale cb; set cbrange [0:1.853943218]
plot table index 0 using ($1):($2):($8/1e0) with image pixels notitle, \
     30*cos(t),30*sin(t) with lines lc rgb "#c0c0c0" dt 1 lw 0.5 notitle, \
     60*cos(t),60*sin(t) with lines lc rgb "#c0c0c0" dt 1 lw 0.5 notitle, \
     90*cos(t),90*sin(t) with lines lc rgb "#404040" dt 1 lw 1 notitle
unset arrow; unset label; unset colorbox
unset object
set colorbox horizontal user origin screen 0.6925,0.24569 size screen 0.265,0.0237069 border
set cbtics  scale 0.5 1 format "%.10g"
set label "(O − E) / √E [σ]" at screen 0.825,0.172414 center noenhanced
set object ellipse center 0,0 size 180,180 units xy behind fillcolor rgb "#d9d9d9" fillstyle solid 1 noborder
set label "" at 45,0 point pt 1 ps 0.9 lc rgb "#000000" lw 1.2 front

# residual
set lmargin at screen 0.6925; set rmargin at screen 0.9575
set bmargin at screen 0.387931; set tmargin at screen 0.844828
unset key; set border 15 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-16.6111022812:90.0000106611]
set xtics autofreq 30 nomirror out scale 0.7,0.4 format "%.10g"
unset logscale y; set yrange [-53.3866742263:53.224438716]
set ytics autofreq 30 nomirror out scale 0.7,0.4 format ""
set label "residual" at screen 0.825,0.875 center
set label "θ cos φ′ [deg]" at screen 0.825,0.306034 center
set palette @sigma
unset logscale cb; set cbrange [-5:5]
plot table index 0 using ($1):($2):($9) with image pixels notitle, \
     30*cos(t),30*sin(t) with lines lc rgb "#808080" dt 1 lw 0.5 notitle, \
     60*cos(t),60*sin(t) with lines lc rgb "#808080" dt 1 lw 0.5 notitle, \
     90*cos(t),90*sin(t) with lines lc rgb "#404040" dt 1 lw 1 notitle
unset arrow; unset label; unset colorbox
unset object

unset multiplot
unset output

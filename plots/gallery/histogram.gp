reset
set encoding utf8
set angles degrees
table = "./histogram" . ".tsv"
if (!exists("picture")) picture = "./histogram" . ".svg"
set terminal svg size 800,464 noenhanced font "sans-serif,12" background "#ffffff"
set output picture
set multiplot

set label "roughconductor:material=Ca,alpha=0.25" at screen 0.5,0.963362 center noenhanced
set label "ωₒ: θ = 45°, φ = 0°;  R, G, B (fit);  1000000 samples, seed 1" at screen 0.5,0.924569 center noenhanced
set label "θ: angle of ωᵢ to the normal; φ′: its azimuth from that of the mirror direction; cross: mirror direction of ωₒ" at screen 0.5,0.12069 center noenhanced
set label "In the window: 99.31% of the samples, 99.31% expected; refused: 0.624%" at screen 0.5,0.0840517 center noenhanced
set label "O observed, E expected in a cell; residual left blank where E < 5: there O = 733, E = 715.52 in all" at screen 0.5,0.0474138 center noenhanced
set xrange [-16.2715782346:90]; set yrange [-52.9229240203:53.3486542143]
set ylabel "θ sin φ′ [deg]"
set xtics out nomirror scale 0.6 30 format "%.10g"
set ytics out nomirror scale 0.6 30; set border lc rgb "#505050"
set parametric; set trange [0:360]; set samples 361
set cbrange [0:1.879529335]
set palette defined (0 "#440154", 1 "#482878", 2 "#3e4a89", 3 "#31688e", 4 "#26828e", 5 "#1f9e89", 6 "#35b779", 7 "#6dcd59", 8 "#b4de2c", 9 "#fde725")
set colorbox horizontal user origin screen 0.09,0.24569 size screen 0.56625,0.0237069 border
set label "density [1/sr]" at screen 0.373125,0.168103 center noenhanced

# samples
set lmargin at screen 0.09; set rmargin at screen 0.355
set bmargin at screen 0.387931; set tmargin at screen 0.844828
set label "samples" at graph 0.5,1.055 center
set label "θ cos φ′ [deg]" at graph 0.5,-0.19 center
set object ellipse center 0,0 size 180,180 units xy behind fillcolor rgb "#d9d9d9" fillstyle solid 1 noborder
set label "" at 45,0 point pt 1 ps 0.9 lc rgb "#ffffff" lw 1.2 front
plot table using ($1/1e0):($2/1e0):($7/1e0) with image pixels notitle, \
     30*cos(t),30*sin(t) with lines lc rgb "#c0c0c0" lw 0.5 notitle, \
     60*cos(t),60*sin(t) with lines lc rgb "#c0c0c0" lw 0.5 notitle, \
     90*cos(t),90*sin(t) with lines lc rgb "#404040" lw 1 notitle
unset object; unset label; unset ylabel; set format y ""
unset colorbox

# pdf, integrated over each cell
set lmargin at screen 0.39125; set rmargin at screen 0.65625
set bmargin at screen 0.387931; set tmargin at screen 0.844828
set label "pdf, integrated over each cell" at graph 0.5,1.055 center
set label "θ cos φ′ [deg]" at graph 0.5,-0.19 center
set object ellipse center 0,0 size 180,180 units xy behind fillcolor rgb "#d9d9d9" fillstyle solid 1 noborder
set label "" at 45,0 point pt 1 ps 0.9 lc rgb "#ffffff" lw 1.2 front
plot table using ($1/1e0):($2/1e0):($8/1e0) with image pixels notitle, \
     30*cos(t),30*sin(t) with lines lc rgb "#c0c0c0" lw 0.5 notitle, \
     60*cos(t),60*sin(t) with lines lc rgb "#c0c0c0" lw 0.5 notitle, \
     90*cos(t),90*sin(t) with lines lc rgb "#404040" lw 1 notitle
unset object; unset label; unset ylabel; set format y ""

set cbrange [-5:5]; set cbtics 1
set palette defined (-5 "#053061", -3.5 "#2166ac", -2 "#67a9cf", -1 "#d1e5f0", 0 "#f7f7f7", 1 "#fddbc7", 2 "#ef8a62", 3.5 "#b2182b", 5 "#67001f")
set colorbox horizontal user origin screen 0.6925,0.24569 size screen 0.265,0.0237069 border
set label "(O − E) / √E [σ]" at screen 0.825,0.168103 center noenhanced

# residual
set lmargin at screen 0.6925; set rmargin at screen 0.9575
set bmargin at screen 0.387931; set tmargin at screen 0.844828
set label "residual" at graph 0.5,1.055 center
set label "θ cos φ′ [deg]" at graph 0.5,-0.19 center
set object ellipse center 0,0 size 180,180 units xy behind fillcolor rgb "#d9d9d9" fillstyle solid 1 noborder
set label "" at 45,0 point pt 1 ps 0.9 lc rgb "#000000" lw 1.2 front
plot table using ($1/1e0):($2/1e0):($9/1e0) with image pixels notitle, \
     30*cos(t),30*sin(t) with lines lc rgb "#808080" lw 0.5 notitle, \
     60*cos(t),60*sin(t) with lines lc rgb "#808080" lw 0.5 notitle, \
     90*cos(t),90*sin(t) with lines lc rgb "#404040" lw 1 notitle
unset object; unset label; unset ylabel; set format y ""

unset multiplot
unset output

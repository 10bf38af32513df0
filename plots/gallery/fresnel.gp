reset
set encoding utf8
set angles degrees
table = "./fresnel" . ".tsv"
if (!exists("picture")) picture = "./fresnel" . ".svg"
degree = "°"
set terminal svg size 800,655 noenhanced font "sans-serif,12" linewidth 1 background "#ffffff"
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

set label "conductor:material=Ca" at screen 0.5,0.974046 center noenhanced
set label "R, G, B (fit)" at screen 0.5,0.946565 center noenhanced
set label "θᵢ: angle of incidence; Schlick\047s R₀ is the exact reflectance at 0°, its angle the one in the thinner medium" at screen 0.5,0.0541985 center noenhanced
set label "thin line: pseudo-Brewster angle, where p is least" at screen 0.5,0.0282443 center noenhanced
set arrow from screen 0.085875,0.0885496 to screen 0.123375,0.0885496 nohead lt 3
set label "s" at screen 0.132125,0.0885496 left noenhanced
set arrow from screen 0.171125,0.0885496 to screen 0.208625,0.0885496 nohead lt 1
set label "p" at screen 0.217375,0.0885496 left noenhanced
set arrow from screen 0.256375,0.0885496 to screen 0.293875,0.0885496 nohead lt 9
set label "unpolarised, exact" at screen 0.302625,0.0885496 left noenhanced
set arrow from screen 0.494625,0.0885496 to screen 0.532125,0.0885496 nohead lt 5
set label "write-up\047s approximation" at screen 0.540875,0.0885496 left noenhanced
set arrow from screen 0.786875,0.0885496 to screen 0.824375,0.0885496 nohead lt 2
set label "Schlick\047s" at screen 0.833125,0.0885496 left noenhanced
set label "R" at screen 0.235833,0.896183 center noenhanced
set label "n = 0.3019, k = 2.945" at screen 0.235833,0.870229 center noenhanced

# reflectance [1]
set lmargin at screen 0.1025; set rmargin at screen 0.369167
set bmargin at screen 0.467176; set tmargin at screen 0.818321
unset key; set border 3 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-9e-06:90.000009]
set xtics autofreq 30 nomirror in scale 0.7,0.4 format ""
unset logscale y; set yrange [-1e-07:1.0000001]
set ytics autofreq 0.2 nomirror in scale 0.7,0.4 format "%.10g"
set label "reflectance [1]" at screen 0.03,0.642748 center rotate by 90
set arrow from first 69.7009616, graph 0 to first 69.7009616, graph 1 nohead back lt 10
set label "pseudo-B. 69.7°" at first 69.7009616, graph 1.045 center tc rgb "#505050"
plot \
     table index 0 using ($1):($2) with lines lt 3 notitle, \
     table index 0 using ($1):($3) with lines lt 1 notitle, \
     table index 0 using ($1):($4) with lines lt 9 notitle, \
     table index 0 using ($1):($5) with lines lt 5 notitle, \
     table index 0 using ($1):($6) with lines lt 2 notitle
unset arrow; unset label; unset colorbox

# approximate − exact [1]
set lmargin at screen 0.1025; set rmargin at screen 0.369167
set bmargin at screen 0.201527; set tmargin at screen 0.4
unset key; set border 3 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-9e-06:90.000009]
set xtics autofreq 30 nomirror in scale 0.7,0.4 format "%.10g"
unset logscale y; set yrange [-0.060000012:0.060000012]
set ytics autofreq 0.02 nomirror in scale 0.7,0.4 format "%.10g"
set label "θᵢ [deg]" at screen 0.235833,0.143511 center
set label "approximate − exact [1]" at screen 0.03,0.300763 center rotate by 90
set arrow from first 69.7009616, graph 0 to first 69.7009616, graph 1 nohead back lt 10
plot \
     table index 0 using ($1):($7) with lines lt 5 notitle, \
     table index 0 using ($1):($8) with lines lt 2 notitle
unset arrow; unset label; unset colorbox
set label "G" at screen 0.535,0.896183 center noenhanced
set label "n = 0.2854, k = 2.323" at screen 0.535,0.870229 center noenhanced

# reflectance [1]
set lmargin at screen 0.401667; set rmargin at screen 0.668333
set bmargin at screen 0.467176; set tmargin at screen 0.818321
unset key; set border 3 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-9e-06:90.000009]
set xtics autofreq 30 nomirror in scale 0.7,0.4 format ""
unset logscale y; set yrange [-1e-07:1.0000001]
set ytics autofreq 0.2 nomirror in scale 0.7,0.4 format ""
set arrow from first 64.10174463, graph 0 to first 64.10174463, graph 1 nohead back lt 10
set label "pseudo-B. 64.1°" at first 64.10174463, graph 1.045 center tc rgb "#505050"
plot \
     table index 1 using ($1):($2) with lines lt 3 notitle, \
     table index 1 using ($1):($3) with lines lt 1 notitle, \
     table index 1 using ($1):($4) with lines lt 9 notitle, \
     table index 1 using ($1):($5) with lines lt 5 notitle, \
     table index 1 using ($1):($6) with lines lt 2 notitle
unset arrow; unset label; unset colorbox

# approximate − exact [1]
set lmargin at screen 0.401667; set rmargin at screen 0.668333
set bmargin at screen 0.201527; set tmargin at screen 0.4
unset key; set border 3 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-9e-06:90.000009]
set xtics autofreq 30 nomirror in scale 0.7,0.4 format "%.10g"
unset logscale y; set yrange [-0.060000012:0.060000012]
set ytics autofreq 0.02 nomirror in scale 0.7,0.4 format ""
set label "θᵢ [deg]" at screen 0.535,0.143511 center
set arrow from first 64.10174463, graph 0 to first 64.10174463, graph 1 nohead back lt 10
plot \
     table index 1 using ($1):($7) with lines lt 5 notitle, \
     table index 1 using ($1):($8) with lines lt 2 notitle
unset arrow; unset label; unset colorbox
set label "B" at screen 0.834167,0.896183 center noenhanced
set label "n = 0.2975, k = 1.714" at screen 0.834167,0.870229 center noenhanced

# reflectance [1]
set lmargin at screen 0.700833; set rmargin at screen 0.9675
set bmargin at screen 0.467176; set tmargin at screen 0.818321
unset key; set border 3 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-9e-06:90.000009]
set xtics autofreq 30 nomirror in scale 0.7,0.4 format ""
unset logscale y; set yrange [-1e-07:1.0000001]
set ytics autofreq 0.2 nomirror in scale 0.7,0.4 format ""
set arrow from first 55.4195364, graph 0 to first 55.4195364, graph 1 nohead back lt 10
set label "pseudo-B. 55.42°" at first 55.4195364, graph 1.045 center tc rgb "#505050"
plot \
     table index 2 using ($1):($2) with lines lt 3 notitle, \
     table index 2 using ($1):($3) with lines lt 1 notitle, \
     table index 2 using ($1):($4) with lines lt 9 notitle, \
     table index 2 using ($1):($5) with lines lt 5 notitle, \
     table index 2 using ($1):($6) with lines lt 2 notitle
unset arrow; unset label; unset colorbox

# approximate − exact [1]
set lmargin at screen 0.700833; set rmargin at screen 0.9675
set bmargin at screen 0.201527; set tmargin at screen 0.4
unset key; set border 3 lc rgb "#505050"; set clip two
unset logscale x; set xrange [-9e-06:90.000009]
set xtics autofreq 30 nomirror in scale 0.7,0.4 format "%.10g"
unset logscale y; set yrange [-0.060000012:0.060000012]
set ytics autofreq 0.02 nomirror in scale 0.7,0.4 format ""
set label "θᵢ [deg]" at screen 0.834167,0.143511 center
set arrow from first 55.4195364, graph 0 to first 55.4195364, graph 1 nohead back lt 10
plot \
     table index 2 using ($1):($7) with lines lt 5 notitle, \
     table index 2 using ($1):($8) with lines lt 2 notitle
unset arrow; unset label; unset colorbox

unset multiplot
unset output

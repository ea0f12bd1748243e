// White slab, closed vein network with fine secondary veins. CC0 1.0.  povray +Ipov_arabescato.pov +W1600 +H3200 +A0.3
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { orthographic location <0.8,1.6,-10> right 1.6*x up 3.2*y look_at <0.8,1.6,0> }

#declare B=pigment{bozo scale 0.2 warp{turbulence 0.4 octaves 5} color_map{[0 rgb <0.80,0.78,0.75>][1 rgb <0.90,0.89,0.87>]}}
#declare V=pigment{crackle form <-1,1,0> scale 0.42 warp{turbulence 0.35 octaves 6 omega 0.55} color_map{[0 rgbt <0.20,0.19,0.19,0>][0.035 rgbt <0.30,0.29,0.28,0.1>][0.09 rgbt <0.55,0.53,0.5,0.55>][0.16 rgbt <0.8,0.8,0.8,1>][1 rgbt 1]}}
#declare V2=pigment{crackle form <-1,1,0> scale 0.17 warp{turbulence 0.5 octaves 6} translate 5 color_map{[0 rgbt <0.45,0.40,0.34,0.2>][0.03 rgbt <0.6,0.56,0.5,0.7>][0.06 rgbt 1][1 rgbt 1]}}
plane{z,0 texture{pigment{B} finish{ambient 1 diffuse 0}} texture{pigment{V2} finish{ambient 1 diffuse 0}} texture{pigment{V} finish{ambient 1 diffuse 0}}}

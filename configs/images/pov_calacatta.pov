// White slab, few long grey veins. CC0 1.0.  povray +Ipov_calacatta.pov +W1600 +H3200 +A0.3
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { orthographic location <0.8,1.6,-10> right 1.6*x up 3.2*y look_at <0.8,1.6,0> }

#declare Base=pigment{bozo scale 0.35 warp{turbulence 0.4 octaves 5} color_map{[0 rgb <0.86,0.85,0.82>][0.6 rgb <0.92,0.91,0.89>][1 rgb <0.80,0.79,0.77>]}}
#declare V1=pigment{marble warp{turbulence <0.55,0.35,0.2> octaves 6 lambda 2.1 omega 0.55} rotate z*35 scale 1.15 color_map{[0 rgbt <0.9,0.9,0.9,1>][0.455 rgbt <0.75,0.74,0.72,1>][0.482 rgbt <0.46,0.45,0.43,0.35>][0.5 rgbt <0.30,0.29,0.28,0>][0.52 rgbt <0.52,0.47,0.40,0.4>][0.56 rgbt <0.8,0.8,0.8,1>][1 rgbt <0.9,0.9,0.9,1>]}}
#declare V2=pigment{marble warp{turbulence <0.8,0.6,0.4> octaves 6 omega 0.6} rotate z*-55 scale 0.55 translate 3.1 color_map{[0 rgbt 1][0.488 rgbt <0.7,0.7,0.7,1>][0.5 rgbt <0.5,0.49,0.47,0.25>][0.512 rgbt <0.7,0.7,0.7,1>][1 rgbt 1]}}
plane{z,0 texture{pigment{Base} finish{ambient 1 diffuse 0}} texture{pigment{V2} finish{ambient 1 diffuse 0}} texture{pigment{V1} finish{ambient 1 diffuse 0}}}

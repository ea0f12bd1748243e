// white, few wide soft veins
#include "slab.inc"
plane { z, 0
  Layer(Cloud(0.4, <0.86,0.86,0.85>, <0.93,0.93,0.92>))
  Layer(Bands(0.7, -35, 0.014, <0.55,0.55,0.56>, <0.9,0.5,0.3>, 5.3))
  Layer(Bands(1.2, 55, 0.03, <0.40,0.40,0.42>, <0.5,0.45,0.2>, 3.7))
}

// black, light veins
#include "slab.inc"
plane { z, 0
  Layer(Cloud(0.25, <0.020,0.020,0.022>, <0.045,0.043,0.042>))
  Layer(Bands(0.45, 25, 0.012, <0.60,0.58,0.55>, <0.9,0.7,0.4>, 4.1))
  Layer(Net(0.5, 0.03, <0.75,0.74,0.72>, 0.5))
}

// white, long grey bands crossed by thin ones
#include "slab.inc"
plane { z, 0
  Layer(Cloud(0.3, <0.84,0.83,0.80>, <0.92,0.91,0.89>))
  Layer(Bands(0.5, -50, 0.018, <0.50,0.49,0.46>, <0.8,0.6,0.4>, 2.3))
  Layer(Bands(0.9, 40, 0.022, <0.32,0.31,0.29>, <0.6,0.4,0.2>, 0.7))
}

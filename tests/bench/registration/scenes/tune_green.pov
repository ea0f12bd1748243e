// green, sheared network over bands
#include "slab.inc"
plane { z, 0
  Layer(Cloud(0.2, <0.22,0.34,0.24>, <0.36,0.48,0.36>))
  Layer(Bands(0.35, 70, 0.02, <0.12,0.18,0.13>, <0.7,0.7,0.4>, 1.9))
  Layer(Net(0.28, 0.05, <0.08,0.12,0.10>, 0.6))
}

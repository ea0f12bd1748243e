// near black, thin golden and white veins
#include "slab.inc"
plane { z, 0
  LayerAt(Cloud(0.3, <0.035,0.030,0.028>, <0.065,0.058,0.052>), <9, 4, 0>)
  LayerAt(Net(0.22, 0.025, <0.55,0.42,0.25>, 0.7), <5, 12, 0>)
  Layer(Bands(0.8, -60, 0.012, <0.75,0.72,0.68>, <0.8,0.6,0.3>, 6.6))
}

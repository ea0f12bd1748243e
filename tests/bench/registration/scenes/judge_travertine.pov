// travertine, near parallel layers with few crossings
#include "slab.inc"
plane { z, 0
  LayerAt(Cloud(0.35, <0.74,0.67,0.56>, <0.85,0.79,0.69>), <2, 8, 0>)
  Layer(Bands(0.22, 84, 0.03, <0.52,0.43,0.32>, <0.25,0.5,0.2>, 9.4))
  LayerAt(Net(0.6, 0.03, <0.40,0.31,0.22>, 0.5), <13, 6, 0>)
}

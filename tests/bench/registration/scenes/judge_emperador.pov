// brown, dark and rusty network
#include "slab.inc"
plane { z, 0
  LayerAt(Cloud(0.18, <0.30,0.21,0.14>, <0.44,0.32,0.22>), <3, 5, 0>)
  LayerAt(Net(0.15, 0.04, <0.16,0.10,0.06>, 0.6), <11, 2, 0>)
  Layer(Bands(0.6, 15, 0.02, <0.10,0.06,0.04>, <0.9,0.8,0.4>, 8.2))
}

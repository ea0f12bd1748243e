// white, closed network with fine side veins
#include "slab.inc"
plane { z, 0
  Layer(Cloud(0.2, <0.78,0.76,0.73>, <0.89,0.88,0.86>))
  LayerAt(Net(0.19, 0.035, <0.50,0.46,0.40>, 0.5), <7, 3, 0>)
  LayerAt(Net(0.45, 0.07, <0.24,0.23,0.23>, 0.4), <4, 9, 0>)
}

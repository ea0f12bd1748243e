// white, sparse thin veins: large empty areas
#include "slab.inc"
plane { z, 0
  LayerAt(Cloud(0.5, <0.87,0.86,0.84>, <0.92,0.92,0.91>), <6, 1, 0>)
  Layer(Bands(1.5, 48, 0.008, <0.38,0.37,0.35>, <0.7,0.5,0.3>, 11.2))
  LayerAt(Net(0.9, 0.02, <0.45,0.43,0.40>, 0.5), <8, 15, 0>)
}

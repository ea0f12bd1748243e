// beige breccia, dense network
#include "slab.inc"
plane { z, 0
  Layer(Cloud(0.15, <0.66,0.58,0.47>, <0.80,0.73,0.62>))
  Layer(Net(0.12, 0.05, <0.42,0.33,0.24>, 0.4))
  Layer(Net(0.33, 0.06, <0.28,0.20,0.15>, 0.3))
}

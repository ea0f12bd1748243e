#include "base/expects.h"
#include "line/products/operator.h"

namespace venato::line {

Operator identity_operator(int nz) {
  VENATO_EXPECTS(nz >= 1);
  Operator op;
  op.stage = "identity";
  op.nz_in = op.nz_out = nz;
  // One sample centred on (0, 0); its width means nothing.
  op.dtheta_s = 1;
  op.theta0_s = -0.5;
  op.deta_m = 1;
  op.eta0_m = -0.5;
  op.full_bed = true;
  op.weight.assign(op.index(nz, 0, 0, 0), 0.0);
  for (int z = 0; z < nz; ++z) op.weight[op.index(z, z, 0, 0)] = 1;
  return op;
}
}  // namespace venato::line

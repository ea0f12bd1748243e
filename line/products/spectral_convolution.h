#pragma once
#include "line/products/bed.h"
#include "line/products/kernel_on_bed.h"
namespace venato::line {

/// mass[k][zout](y, x) = sum over zin, dy, dx of kernel * mass[k][zin](y - dy, x - dx), y periodic, x mirrored at the walls: exact to rounding, also
/// for kernels wider than the bed. kernel.nz_in = kernel.nz_out = 1 on a bed with more layers: every layer alike. In place: two powders travel as the
/// real and imaginary part of one complex field, the cosine spectra across the belt overwrite the masses, and each block of 8 cosine columns is
/// transformed along the belt, mixed between layers and transformed back. Extra memory: a few MB per thread. Bits do not depend on `threads`: blocks
/// share nothing. Cost: per 8 cosine columns nz^2 / 2 kernel
/// and 4 nz field transforms along the belt; 1800 x 3700 x 10 with 2 powders about 6 core-seconds, 700 x 1600 x 10 about 1.
void convolve_in_place(Bed& bed, const BedKernel& kernel, int threads);
}  // namespace venato::line

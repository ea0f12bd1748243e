#include "dem/fields/contact_line.h"

namespace venato::dem {

ContactLine contact_line(const ContactState& c, const GrainState& i, const GrainState* j) {
  ContactLine line;
  const bool other_is_wall = j == nullptr || j->frozen;
  line.none = i.frozen && other_is_wall;
  line.wall = i.frozen || other_is_wall;
  const Vec3 touch = i.position_m + (i.radius_m - (j == nullptr ? 1 : 0.5) * c.overlap_m) * c.normal;
  // The nearest image of j, whichever j->position_m is.
  const Vec3 other = j == nullptr ? touch : Vec3(i.position_m + (i.radius_m + j->radius_m - c.overlap_m) * c.normal);
  line.from = i.frozen ? other : i.position_m;
  line.force_n = i.frozen ? Vec3(-c.force_n) : c.force_n;
  line.to = line.wall ? touch : other;
  return line;
}
}  // namespace venato::dem

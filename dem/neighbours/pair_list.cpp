#include "dem/neighbours/pair_list.h"

#include <algorithm>

namespace venato::dem {
namespace {
constexpr std::int64_t kBlock = 256;
struct Neighbour {
  std::int64_t id;
  std::int32_t slot, image;
};

/// Full rows (partners below and above) of a block of grains, one after the other.
struct BlockRows {
  std::vector<Neighbour> row;
  std::vector<std::int32_t> end;
};

/// Image of j nearest to i; unique because the box is at least two cutoffs long.
inline std::int32_t nearest_image(double d[3], const PeriodicBox& box) {
  std::int32_t code = 0, weight = 1;
  for (std::size_t a = 0; a < 3; ++a, weight *= 3) {
    std::int32_t step = 1;
    if (box.length[a] > 0) {
      if (d[a] > 0.5 * box.length[a])
        d[a] -= box.length[a], step = 0;
      else if (d[a] < -0.5 * box.length[a])
        d[a] += box.length[a], step = 2;
    }
    code += step * weight;
  }
  return code;
}

void find_row(const PairListInput& in, std::int32_t i, std::vector<Neighbour>& out) {
  const Sphere& s = in.spheres[static_cast<std::size_t>(i)];
  auto test = [&](std::int32_t from, std::int32_t to) {
    for (std::int32_t j = from; j < to; ++j) {
      if (j == i) continue;
      const Sphere& t = in.spheres[static_cast<std::size_t>(j)];
      double d[3] = {t.x - s.x, t.y - s.y, t.z - s.z};
      const std::int32_t image = nearest_image(d, in.box);
      const double reach = s.r + t.r + in.skin;
      if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach) out.push_back({in.id[static_cast<std::size_t>(j)], j, image});
    }
  };
  const std::size_t begin = out.size();
  if (in.grid)
    in.grid->for_runs_near(s.x, s.y, s.z, s.r + in.skin, test);
  else
    test(0, static_cast<std::int32_t>(in.spheres.size()));
  // Insertion sort: a dozen entries, nearly in order.
  for (std::size_t k = begin + 1; k < out.size(); ++k) {
    const Neighbour n = out[k];
    std::size_t q = k;
    for (; q > begin && out[q - 1].id > n.id; --q) out[q] = out[q - 1];
    out[q] = n;
  }
}
}  // namespace

std::vector<Trio> image_shifts(const PeriodicBox& box) {
  std::vector<Trio> shift;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) shift.push_back({x * box.length[0], y * box.length[1], z * box.length[2]});
  return shift;
}

void rebuild_pairs(PairList& list, PairList& spare, const PairListInput& in) {
  const std::int64_t n = static_cast<std::int64_t>(in.spheres.size()), blocks = (n + kBlock - 1) / kBlock;
  std::swap(list, spare);
  const PairList& old = spare;
  std::vector<BlockRows> rows(static_cast<std::size_t>(blocks));
  list.first.assign(static_cast<std::size_t>(n) + 1, 0);
  list.incident_first.assign(static_cast<std::size_t>(n) + 1, 0);
  const int threads = in.threads;

#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (std::int64_t b = 0; b < blocks; ++b) {
    BlockRows& out = rows[static_cast<std::size_t>(b)];
    out.row.reserve(static_cast<std::size_t>(kBlock) * 14);
    for (std::int64_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) {
      const std::size_t begin = out.row.size(), s = static_cast<std::size_t>(i);
      find_row(in, static_cast<std::int32_t>(i), out.row);
      out.end.push_back(static_cast<std::int32_t>(out.row.size()));
      std::int32_t own = 0;
      for (std::size_t k = begin; k < out.row.size(); ++k) own += out.row[k].id > in.id[s];
      list.first[s + 1] = own;
      list.incident_first[s + 1] = static_cast<std::int32_t>(out.row.size() - begin);
    }
  }
  for (std::size_t k = 1; k < list.first.size(); ++k) {
    list.first[k] += list.first[k - 1];
    list.incident_first[k] += list.incident_first[k - 1];
  }
  const std::size_t pairs = static_cast<std::size_t>(list.first.back());
  list.pair.resize(pairs);
  list.partner.resize(pairs);
  list.touching.assign(pairs, 0);
  list.history.resize_for_overwrite(pairs);
  list.force.resize_for_overwrite(pairs);
  list.incident.resize(static_cast<std::size_t>(list.incident_first.back()));
  const std::int32_t old_count = static_cast<std::int32_t>(old.grain_count());

#pragma omp parallel num_threads(threads) if (threads > 1)
  {
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t b = 0; b < blocks; ++b) {
      const BlockRows& in_rows = rows[static_cast<std::size_t>(b)];
      std::size_t k = 0;
      for (std::int64_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) {
        const std::size_t s = static_cast<std::size_t>(i), end = static_cast<std::size_t>(in_rows.end[s - static_cast<std::size_t>(b * kBlock)]);
        const std::int32_t was = in.old_slot[s];
        std::size_t from = 0, from_end = 0;
        if (was < old_count)
          from = static_cast<std::size_t>(old.first[static_cast<std::size_t>(was)]),
          from_end = static_cast<std::size_t>(old.first[static_cast<std::size_t>(was) + 1]);
        std::size_t p = static_cast<std::size_t>(list.first[s]);
        for (; k < end; ++k) {
          const Neighbour& q = in_rows.row[k];
          if (q.id < in.id[s]) continue;
          list.pair[p] = {q.slot, q.image};
          list.partner[p] = q.id;
          while (from < from_end && old.partner[from] < q.id) ++from;
          if (from < from_end && old.partner[from] == q.id && old.touching[from]) {
            list.touching[p] = 1;
            list.history[p] = old.history[from];
            list.force[p] = old.force[from];
          }
          ++p;
        }
      }
    }
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t b = 0; b < blocks; ++b) {
      const BlockRows& in_rows = rows[static_cast<std::size_t>(b)];
      std::size_t k = 0;
      for (std::int64_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) {
        const std::size_t s = static_cast<std::size_t>(i), end = static_cast<std::size_t>(in_rows.end[s - static_cast<std::size_t>(b * kBlock)]);
        std::uint32_t own = static_cast<std::uint32_t>(list.first[s]);
        for (std::size_t at = static_cast<std::size_t>(list.incident_first[s]); k < end; ++k, ++at) {
          const Neighbour& q = in_rows.row[k];
          if (q.id > in.id[s]) {
            list.incident[at] = 2 * own++;
          } else {  // the pair stands in the partner's row
            const auto row = list.partner.begin() + list.first[static_cast<std::size_t>(q.slot)],
                       row_end = list.partner.begin() + list.first[static_cast<std::size_t>(q.slot) + 1];
            const auto found = std::lower_bound(row, row_end, in.id[s]);
            list.incident[at] = 2 * static_cast<std::uint32_t>(found - list.partner.begin()) + 1;
          }
        }
      }
    }
  }
}
}  // namespace venato::dem

#include "dem/neighbours/pair_list.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace venato::dem {
namespace {
constexpr std::int64_t kBlock = 256;
constexpr double kRounding = 1 + 1e-9;  // of the reach: rounding of the paths never hides a pair
}  // namespace

void PairList::resize_pairs(std::size_t n) {
  for (RawArray<std::int32_t>* a : {&i, &j}) {
    a->resize_for_overwrite(n + kListPadding);
    std::fill_n(a->data() + n, kListPadding, 0);
  }
  for (RawArray<std::uint8_t>* a : {&touching, &in_touching}) {
    a->resize_for_overwrite(n + kListPadding);
    std::memset(a->data(), 0, n + kListPadding);
  }
  history.resize_for_overwrite(n);
  force.resize_for_overwrite(n);
  in_place.resize_for_overwrite(n);
  in_pair.resize_for_overwrite(n);
}

void PairListBuilder::find_row(const PairListInput& in, std::int32_t i, std::vector<Neighbour>& out) {
  const std::size_t si = static_cast<std::size_t>(i);
  const Sphere s = in.spheres[si];
  const Anchor a = in.anchor[si];
  const double reach = in.reach[si], grown = s.r + static_cast<double>(a.allowance);
  const bool wraps = in.box.periodic(0) || in.box.periodic(1) || in.box.periodic(2);
  auto test = [&](std::int32_t from, std::int32_t to) {
    for (std::int32_t j = from; j < to; ++j) {
      const std::size_t sj = static_cast<std::size_t>(j);
      const Sphere& t = in.spheres[sj];
      double d[3] = {t.x - s.x, t.y - s.y, t.z - s.z};
      if (wraps)
        for (std::size_t k = 0; k < 3; ++k)  // wrapped already: at most one box length off
          if (in.box.length[k] > 0) d[k] -= d[k] > 0.5 * in.box.length[k] ? in.box.length[k] : (d[k] < -0.5 * in.box.length[k] ? -in.box.length[k] : 0);
      const double far = reach + in.reach[sj];
      if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] >= far * far || j == i) continue;
      const Anchor& b = in.anchor[sj];
      if (!meet_within(d[0], d[1], d[2], static_cast<double>(b.drift_x) - static_cast<double>(a.drift_x),
                       static_cast<double>(b.drift_y) - static_cast<double>(a.drift_y), static_cast<double>(b.drift_z) - static_cast<double>(a.drift_z),
                       kRounding * (grown + t.r + static_cast<double>(b.allowance)), in.life_s))
        continue;
      out.push_back({in.id[sj], j});
    }
  };
  const std::size_t begin = out.size();
  if (in.grid)
    in.grid->for_runs_near(s.x, s.y, s.z, reach, test);
  else
    test(0, static_cast<std::int32_t>(in.spheres.size()));
  // Insertion sort: a dozen entries.
  for (std::size_t k = begin + 1; k < out.size(); ++k) {
    const Neighbour n = out[k];
    std::size_t q = k;
    for (; q > begin && out[q - 1].id > n.id; --q) out[q] = out[q - 1];
    out[q] = n;
  }
}

/// Own pairs of slot s, with what the old list knows of them, and their entries among the partners' incoming ones.
void PairListBuilder::fill_rows(PairList& list, const PairListInput& in, std::size_t s) const {
  const PairList& old = spare_;
  const std::size_t block = static_cast<std::size_t>(kBlock);
  const std::span<const Neighbour> row = rows_[s / block].of(s % block);
  const std::size_t was = static_cast<std::size_t>(in.old_slot[s]);
  std::size_t from = 0, from_end = 0;
  if (was < old.grain_count()) from = static_cast<std::size_t>(old.first[was]), from_end = static_cast<std::size_t>(old.first[was + 1]);
  std::size_t p = static_cast<std::size_t>(list.first[s]);
  for (const Neighbour& q : row.subspan(static_cast<std::size_t>(list.in_first[s + 1] - list.in_first[s]))) {
    const std::size_t partner = static_cast<std::size_t>(q.slot);
    list.i[p] = static_cast<std::int32_t>(s);
    list.j[p] = q.slot;
    const std::span<const Neighbour> theirs = rows_[partner / block].of(partner % block);
    const auto found = std::lower_bound(theirs.begin(), theirs.end(), in.id[s], [](const Neighbour& x, std::int64_t id) { return x.id < id; });
    const std::size_t place = static_cast<std::size_t>(list.in_first[partner] + (found - theirs.begin()));
    list.in_place[p] = static_cast<std::int32_t>(place);
    list.in_pair[place] = static_cast<std::int32_t>(p);
    while (from < from_end && old.id[static_cast<std::size_t>(old.j[from])] < q.id) ++from;
    if (from < from_end && old.touching[from] && old.id[static_cast<std::size_t>(old.j[from])] == q.id) {
      list.touching[p] = list.in_touching[place] = 1;
      list.history[p] = old.history[from];
      list.force[p] = old.force[from];
    }
    ++p;
  }
}

void PairListBuilder::rebuild(PairList& list, const PairListInput& in) {
  const std::int64_t n = static_cast<std::int64_t>(in.spheres.size()), blocks = (n + kBlock - 1) / kBlock;
  std::swap(list, spare_);
  rows_.resize(static_cast<std::size_t>(blocks));
  list.first.assign(static_cast<std::size_t>(n) + 1, 0);
  list.in_first.assign(static_cast<std::size_t>(n) + 1, 0);
  list.id.resize_for_overwrite(static_cast<std::size_t>(n));
  std::copy(in.id.begin(), in.id.end(), list.id.data());
  const int threads = in.threads;

#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (std::int64_t b = 0; b < blocks; ++b) {
    BlockRows& out = rows_[static_cast<std::size_t>(b)];
    out.row.clear(), out.end.clear();
    for (std::int64_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) {
      const std::size_t begin = out.row.size(), s = static_cast<std::size_t>(i);
      find_row(in, static_cast<std::int32_t>(i), out.row);
      out.end.push_back(static_cast<std::int32_t>(out.row.size()));
      std::int32_t incoming = 0;
      for (std::size_t k = begin; k < out.row.size(); ++k) incoming += out.row[k].id < in.id[s];
      list.in_first[s + 1] = incoming;
      list.first[s + 1] = static_cast<std::int32_t>(out.row.size() - begin) - incoming;
    }
  }
  for (std::size_t k = 1; k < list.first.size(); ++k) {
    list.first[k] += list.first[k - 1];
    list.in_first[k] += list.in_first[k - 1];
  }
  list.resize_pairs(static_cast<std::size_t>(list.first.back()));

#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (std::int64_t b = 0; b < blocks; ++b)
    for (std::int64_t i = b * kBlock; i < std::min(n, (b + 1) * kBlock); ++i) fill_rows(list, in, static_cast<std::size_t>(i));
}
}  // namespace venato::dem

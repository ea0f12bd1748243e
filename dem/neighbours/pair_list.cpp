#include "dem/neighbours/pair_list.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace venato::dem {
namespace {
constexpr double kRounding = 1 + 1e-9;  // of the reach: rounding of the paths never hides a pair
constexpr std::uint32_t kSecond = 0x80000000u;
}  // namespace

void PairList::resize(std::size_t pairs, std::size_t entries) {
  own.resize_for_overwrite(pairs + kListPadding);
  std::fill_n(own.data() + pairs, kListPadding, std::uint16_t{0});
  partner.resize_for_overwrite(pairs + kListPadding);
  std::fill_n(partner.data() + pairs, kListPadding, 0);
  touching.resize_for_overwrite(pairs + kListPadding);
  std::memset(touching.data(), 0, pairs + kListPadding);
  place.resize_for_overwrite(pairs);
  row.resize_for_overwrite(entries);
}

void PairList::start(std::size_t block, std::size_t pair, const ContactHistory& h) {
  place[pair] = contacts[block].take(history_width);
  double* kept = contacts[block].history(place[pair], history_width);
  kept[0] = h.spring.x, kept[1] = h.spring.y, kept[2] = h.spring.z, kept[3] = h.rolling.x, kept[4] = h.rolling.y, kept[5] = h.rolling.z;
  if (history_width > 6) kept[6] = h.plastic, kept[7] = 0;
  touching[pair] = 1;
  contacts[block].sides += sides(block, pair);
}
void PairList::end(std::size_t block, std::size_t pair) {
  contacts[block].vacant.push_back(place[pair]);
  touching[pair] = 0;
  contacts[block].sides -= sides(block, pair);
}

void PairListBuilder::find_row(const PairListInput& in, const NearField& field, std::int32_t i, Search& search) {
  const std::size_t si = static_cast<std::size_t>(i);
  const Sphere s = in.spheres[si];
  const Anchor& a = in.anchor[si];
  const double grown = s.r + static_cast<double>(a.allowance);
  search.runs.clear(), search.row.clear();
  std::size_t most = 0;
  auto take = [&](std::int32_t from, std::int32_t to) { search.runs.emplace_back(from, to), most += static_cast<std::size_t>(to - from); };
  std::size_t found = 0;
  if (in.grid) {
    in.grid->for_runs_near(s.x, s.y, s.z, in.reach[si], take);
    if (search.near.size() < most + 16) search.near.resize(most + 16);
    found = near_scan(field, i, search.runs, search.near.data());
  } else {  // the slow obvious way, for tests: everybody, exactly
    search.near.resize(in.spheres.size());
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(in.spheres.size()); ++j)
      if (j != i) search.near[found++] = j;
  }
  for (std::size_t k = 0; k < found; ++k) {
    const std::size_t sj = static_cast<std::size_t>(search.near[k]);
    const Sphere& t = in.spheres[sj];
    double d[3] = {t.x - s.x, t.y - s.y, t.z - s.z};
    for (std::size_t c = 0; c < 3; ++c)  // wrapped already: at most one box length off
      if (in.box.length[c] > 0) d[c] -= d[c] > 0.5 * in.box.length[c] ? in.box.length[c] : (d[c] < -0.5 * in.box.length[c] ? -in.box.length[c] : 0);
    const Anchor& b = in.anchor[sj];
    if (meet_within(d[0], d[1], d[2], static_cast<double>(b.drift_x) - static_cast<double>(a.drift_x),
                    static_cast<double>(b.drift_y) - static_cast<double>(a.drift_y), static_cast<double>(b.drift_z) - static_cast<double>(a.drift_z),
                    kRounding * (grown + (t.r + static_cast<double>(b.allowance))), in.life_s))
      search.row.emplace_back(in.id[sj], search.near[k]);
  }
  // Insertion sort: a dozen entries.
  for (std::size_t k = 1; k < search.row.size(); ++k) {
    const auto n = search.row[k];
    std::size_t q = k;
    for (; q > 0 && search.row[q - 1].first > n.first; --q) search.row[q] = search.row[q - 1];
    search.row[q] = n;
  }
}

/// Pairs of a block in the order of (lower id, higher id), with the rows' entries for their first grains. A grain's pairs with higher ids are one run
/// of its row; pairs with a grain of another block that has the lower id come singly.
void PairListBuilder::order_pairs(PairList& list, const PairListInput& in, std::size_t block) const {
  const BlockRows& rows = rows_[block];
  const std::size_t start = PairList::block_start(block), end = std::min(start + static_cast<std::size_t>(kGrainsPerBlock), in.spheres.size());
  struct Run {
    std::int64_t lower, higher;     // ids; higher is the first of the run
    std::uint32_t grain, from, to;  // entries of the grain's row
  };
  std::vector<Run> runs;
  runs.reserve(3 * static_cast<std::size_t>(kGrainsPerBlock));
  for (std::size_t s = start; s < end; ++s) {
    const std::span<const std::int32_t> row = rows.of(s - start);
    auto id = [&](std::uint32_t k) { return in.id[static_cast<std::size_t>(row[k])]; };
    std::uint32_t k = 0;
    for (; k < row.size() && id(k) < in.id[s]; ++k) {
      const std::size_t other = static_cast<std::size_t>(row[k]);
      if (other < start || other >= end) runs.push_back({id(k), in.id[s], static_cast<std::uint32_t>(s - start), k, k + 1});
    }
    if (k < row.size()) runs.push_back({in.id[s], id(k), static_cast<std::uint32_t>(s - start), k, static_cast<std::uint32_t>(row.size())});
  }
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.lower != b.lower ? a.lower < b.lower : a.higher < b.higher; });
  const std::size_t first = static_cast<std::size_t>(list.block_first[block]);
  std::size_t p = first;
  for (const Run& r : runs) {
    const std::span<const std::int32_t> row = rows.of(r.grain);
    for (std::uint32_t k = r.from; k < r.to; ++k, ++p) {
      list.own[p] = static_cast<std::uint16_t>(r.grain);
      list.partner[p] = row[k];
      list.row[static_cast<std::size_t>(list.row_first[start + r.grain]) + k].code = static_cast<std::uint32_t>(p - first);
    }
  }
}

/// Pairs and rows of a block, then what the old list knows of their contacts.
void PairListBuilder::fill_block(PairList& list, const PairList& old, const PairListInput& in, std::size_t block) const {
  const BlockRows& rows = rows_[block];
  const std::size_t start = PairList::block_start(block), end = std::min(start + static_cast<std::size_t>(kGrainsPerBlock), in.spheres.size());
  auto inside = [&](std::int32_t slot) { return static_cast<std::size_t>(slot) >= start && static_cast<std::size_t>(slot) < end; };
  order_pairs(list, in, block);
  for (std::size_t s = start; s < end; ++s) {
    std::size_t e = static_cast<std::size_t>(list.row_first[s]);
    for (const std::int32_t slot : rows.of(s - start)) {
      const std::size_t other = static_cast<std::size_t>(slot);
      if (inside(slot) && in.id[other] < in.id[s]) {  // the pair stands with its other grain
        const std::span<const std::int32_t> theirs = rows.of(other - start);
        const auto found = std::find(theirs.begin(), theirs.end(), static_cast<std::int32_t>(s));
        list.row[e].code = list.row[static_cast<std::size_t>(list.row_first[other] + (found - theirs.begin()))].code | kSecond;
      }
      ++e;
    }
  }
  list.contacts[block] = BlockContacts();
  for (std::size_t s = start; s < end; ++s) carry(list, old, in, block, s);
}

void PairListBuilder::carry(PairList& list, const PairList& old, const PairListInput& in, std::size_t block, std::size_t s) const {
  const std::size_t was = static_cast<std::size_t>(in.old_slot[s]);
  if (was >= old.grain_count()) return;
  std::size_t from = static_cast<std::size_t>(old.row_first[was]);
  const std::size_t from_end = static_cast<std::size_t>(old.row_first[was + 1]), e0 = static_cast<std::size_t>(list.row_first[s]);
  const std::span<const std::int32_t> row = rows_[block].of(s - PairList::block_start(block));
  for (std::size_t k = 0; k < row.size(); ++k) {
    if (list.row[e0 + k].second()) continue;
    const std::int64_t id = in.id[static_cast<std::size_t>(row[k])];
    for (; from < from_end; ++from)
      if (old.touching[old.pair_of(was, old.row[from])] && old.id[old.other(was, old.row[from])] >= id) break;
    if (from == from_end) return;
    if (old.id[old.other(was, old.row[from])] != id) continue;
    const ContactHistory h = old.history_of(PairList::block_of(was), old.pair_of(was, old.row[from]));
    list.start(block, static_cast<std::size_t>(list.block_first[block]) + list.row[e0 + k].pair(), old.row[from].second() ? mirrored(h) : h);
  }
}

void PairListBuilder::rebuild(PairList& list, const PairListInput& in) {
  const std::int64_t n = static_cast<std::int64_t>(in.spheres.size()), blocks = (n + kGrainsPerBlock - 1) / kGrainsPerBlock;
  const PairList old = std::exchange(list, PairList());
  list.history_width = old.history_width;
  rows_.resize(static_cast<std::size_t>(blocks));
  list.row_first.assign(static_cast<std::size_t>(n) + 1, 0);
  list.block_first.assign(static_cast<std::size_t>(blocks) + 1, 0);
  list.contacts.resize(static_cast<std::size_t>(blocks));
  list.id.resize_for_overwrite(static_cast<std::size_t>(n));
  std::copy(in.id.begin(), in.id.end(), list.id.data());
  const int threads = in.threads;
  const NearField field = make_near_field(in.spheres, in.reach, in.box, threads);

#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    Search search;
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t b = 0; b < blocks; ++b) {
      BlockRows& out = rows_[static_cast<std::size_t>(b)];
      out.row.clear(), out.end.clear();
      std::int32_t pairs = 0;
      const std::int64_t start = b * kGrainsPerBlock, end = std::min(n, start + kGrainsPerBlock);
      for (std::int64_t i = start; i < end; ++i) {
        const std::size_t s = static_cast<std::size_t>(i);
        find_row(in, field, static_cast<std::int32_t>(i), search);
        for (const auto& [id, slot] : search.row) {
          pairs += slot < start || slot >= end || id > in.id[s];
          out.row.push_back(slot);
        }
        out.end.push_back(static_cast<std::int32_t>(out.row.size()));
        list.row_first[s + 1] = static_cast<std::int32_t>(search.row.size());
      }
      list.block_first[static_cast<std::size_t>(b) + 1] = pairs;
    }
  }
  for (std::size_t k = 1; k < list.row_first.size(); ++k) list.row_first[k] += list.row_first[k - 1];
  for (std::size_t k = 1; k < list.block_first.size(); ++k) list.block_first[k] += list.block_first[k - 1];
  list.resize(list.pair_count(), static_cast<std::size_t>(list.row_first.back()));

#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (std::int64_t b = 0; b < blocks; ++b) fill_block(list, old, in, static_cast<std::size_t>(b));
}
}  // namespace venato::dem

#include "dem/neighbours/pair_list.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "dem/neighbours/near_scan.h"

namespace venato::dem {

void PairList::resize(std::size_t pairs) {
  own.resize_for_overwrite(pairs + kListPadding);
  std::fill_n(own.data() + pairs, kListPadding, std::uint16_t{0});
  partner.resize_for_overwrite(pairs + kListPadding);
  std::fill_n(partner.data() + pairs, kListPadding, 0);
  touching.resize_for_overwrite(pairs + kListPadding);
  std::memset(touching.data(), 0, pairs + kListPadding);
  place.resize_for_overwrite(pairs);
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

namespace {
constexpr double kRounding = 1 + 1e-9;  // of the reach: rounding of the paths never hides a pair

/// Pairs of a block by first grain, with ascending ids of the partners.
struct BlockRows {
  std::vector<std::int32_t> row;  ///< slots of the partners
  std::vector<std::int32_t> end;
  std::span<const std::int32_t> of(std::size_t k) const {
    const std::size_t begin = k == 0 ? 0 : static_cast<std::size_t>(end[k - 1]);
    return {row.data() + begin, static_cast<std::size_t>(end[k]) - begin};
  }
};

struct Search {  ///< working memory of one thread
  std::vector<std::pair<std::int32_t, std::int32_t>> runs;
  std::vector<std::int32_t> near;
  std::vector<std::pair<std::int64_t, std::int32_t>> row;  ///< (id, slot)
  std::vector<std::int32_t> block_row;
};

/// Partners of the pairs that stand in the block of grain i with i as their first grain: of its own block those with higher ids, of others all.
void find_row(const PairListInput& in, const NearField& field, std::int32_t i, Search& search) {
  const std::size_t si = static_cast<std::size_t>(i), block = PairList::block_of(si);
  const Sphere s = in.spheres[si];
  const Anchor& a = in.anchor[si];
  const double grown = s.r + static_cast<double>(a.allowance);
  const std::int64_t own_id = in.id[si];
  search.runs.clear(), search.row.clear();
  std::size_t most = 0;
  auto take = [&](std::int32_t from, std::int32_t to) { search.runs.emplace_back(from, to), most += static_cast<std::size_t>(to - from); };
  std::size_t found = 0;
  if (in.grid) {
    in.grid->for_runs_near(s.x, s.y, s.z, in.reach[si], take);
    if (search.near.size() < most + 16) search.near.resize(most + 16);
    found = near_scan(field, field.place.empty() ? i : field.place[si], search.runs, search.near.data());
    for (std::size_t k = 0; k < found; ++k) search.near[k] = in.grid->slot(search.near[k]);
  } else {  // the slow obvious way, for tests: everybody, exactly
    search.near.resize(in.spheres.size());
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(in.spheres.size()); ++j)
      if (j != i) search.near[found++] = j;
  }
  for (std::size_t k = 0; k < found; ++k) {
    const std::size_t sj = static_cast<std::size_t>(search.near[k]);
    if (PairList::block_of(sj) == block && in.id[sj] < own_id) continue;
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
  // Insertion sort: ten entries.
  for (std::size_t k = 1; k < search.row.size(); ++k) {
    const auto n = search.row[k];
    std::size_t q = k;
    for (; q > 0 && search.row[q - 1].first > n.first; --q) search.row[q] = search.row[q - 1];
    search.row[q] = n;
  }
}

struct Workshop {  ///< working memory of one thread
  struct Run {
    std::int64_t lower, higher;     // ids; higher is the first of the run
    std::uint32_t grain, from, to;  // entries of the grain's row
  };
  std::vector<Run> runs;
  struct Heir {
    std::size_t pair;
    const double* history;
    bool mirror;
  };
  std::vector<Heir> heirs;
};

/// Pairs of a block in the order of (lower id, higher id). A grain's pairs with higher ids are one run of its row; pairs with a grain of another
/// block that has the lower id come singly.
void order_pairs(PairList& list, const BlockRows& rows, const PairListInput& in, std::size_t block, Workshop& work) {
  const std::size_t start = PairList::block_start(block), end = std::min(start + static_cast<std::size_t>(kGrainsPerBlock), in.spheres.size());
  work.runs.clear();
  for (std::size_t s = start; s < end; ++s) {
    const std::span<const std::int32_t> row = rows.of(s - start);
    auto id = [&](std::uint32_t k) { return in.id[static_cast<std::size_t>(row[k])]; };
    std::uint32_t k = 0;
    for (; k < row.size() && id(k) < in.id[s]; ++k) work.runs.push_back({id(k), in.id[s], static_cast<std::uint32_t>(s - start), k, k + 1});
    if (k < row.size()) work.runs.push_back({in.id[s], id(k), static_cast<std::uint32_t>(s - start), k, static_cast<std::uint32_t>(row.size())});
  }
  std::sort(work.runs.begin(), work.runs.end(),
            [](const Workshop::Run& a, const Workshop::Run& b) { return a.lower != b.lower ? a.lower < b.lower : a.higher < b.higher; });
  std::size_t p = static_cast<std::size_t>(list.block_first[block]);
  for (const Workshop::Run& r : work.runs) {
    const std::span<const std::int32_t> row = rows.of(r.grain);
    for (std::uint32_t k = r.from; k < r.to; ++k, ++p) list.own[p] = static_cast<std::uint16_t>(r.grain), list.partner[p] = row[k];
  }
}

/// What the old list knew of the contacts of a block.
void carry(PairList& list, const ContactEstate& estate, const PairListInput& in, std::size_t block, Workshop& work) {
  work.heirs.clear();
  for (std::size_t p = static_cast<std::size_t>(list.block_first[block]); p < static_cast<std::size_t>(list.block_first[block + 1]); ++p) {
    std::size_t lower = PairList::block_start(block) + list.own[p], higher = static_cast<std::size_t>(list.partner[p]);
    const bool mirror = in.id[higher] < in.id[lower];
    if (mirror) std::swap(lower, higher);
    if (const double* h = estate.history(static_cast<std::size_t>(in.old_slot[lower]), static_cast<std::size_t>(in.old_slot[higher])))
      work.heirs.push_back({p, h, mirror});
  }
  BlockContacts& contacts = list.contacts[block];
  contacts = BlockContacts();
  contacts.rows.grow(BlockContacts::lines(work.heirs.size() + work.heirs.size() / 8 + 16, list.history_width));
  for (const Workshop::Heir& heir : work.heirs) {
    const double* h = heir.history;
    const ContactHistory seen{{h[0], h[1], h[2]}, {h[3], h[4], h[5]}, list.history_width > 6 ? h[6] : 0.0};
    list.start(block, heir.pair, heir.mirror ? mirrored(seen) : seen);
  }
}

}  // namespace

void rebuild_pairs(PairList& list, const ContactEstate& estate, const PairListInput& in) {
  const std::int64_t n = static_cast<std::int64_t>(in.spheres.size()), blocks = (n + kGrainsPerBlock - 1) / kGrainsPerBlock;
  std::vector<BlockRows> all_rows(static_cast<std::size_t>(blocks));
  list.grain_count = in.spheres.size();
  list.block_first.assign(static_cast<std::size_t>(blocks) + 1, 0);
  list.contacts.resize(static_cast<std::size_t>(blocks));
  const int threads = in.threads;
  {
    const NearField field = make_near_field(in.spheres, in.reach, in.grid ? in.grid->slots() : std::span<const std::int32_t>(), in.box, threads);
#pragma omp parallel num_threads(threads) if (threads > 1)
    {
      Search search;
#pragma omp for schedule(dynamic, 1)
      for (std::int64_t b = 0; b < blocks; ++b) {
        BlockRows& out = all_rows[static_cast<std::size_t>(b)];
        search.block_row.clear();
        for (std::int64_t i = b * kGrainsPerBlock; i < std::min(n, (b + 1) * kGrainsPerBlock); ++i) {
          find_row(in, field, static_cast<std::int32_t>(i), search);
          for (const auto& [id, slot] : search.row) search.block_row.push_back(slot);
          out.end.push_back(static_cast<std::int32_t>(search.block_row.size()));
        }
        out.row = search.block_row;  // no longer than it is
        list.block_first[static_cast<std::size_t>(b) + 1] = static_cast<std::int32_t>(out.row.size());
      }
    }
  }
  for (std::size_t k = 1; k < list.block_first.size(); ++k) list.block_first[k] += list.block_first[k - 1];
  list.resize(list.pair_count());

#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    Workshop work;
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t i = 0; i < blocks; ++i) {
      const std::size_t b = static_cast<std::size_t>(i);
      order_pairs(list, all_rows[b], in, b, work);
      carry(list, estate, in, b, work);
    }
  }
}
}  // namespace venato::dem

#include "dem/neighbours/contact_estate.h"

#include <algorithm>

#include "dem/neighbours/pair_list.h"

namespace venato::dem {

ContactEstate::ContactEstate(PairList& list, std::span<const std::int64_t> id, int threads)
    : grains_(list.grain_count), width_(list.history_width), block_(list.contacts.size()) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
  for (std::size_t b = 0; b < block_.size(); ++b) {
    Block& out = block_[b];
    const std::size_t start = PairList::block_start(b), first = static_cast<std::size_t>(list.block_first[b]);
    const std::size_t last = static_cast<std::size_t>(list.block_first[b + 1]);
    // A pair across a border stands in both blocks; it is handed on from the one of its grain with the lower id.
    const auto counts = [&](std::size_t p) { return list.touching[p] && id[start + list.own[p]] < id[static_cast<std::size_t>(list.partner[p])]; };
    std::uint32_t next[kGrainsPerBlock + 1] = {};
    for (std::size_t p = first; p < last; ++p)
      if (counts(p)) ++next[list.own[p] + 1];
    for (std::size_t k = 0; k < static_cast<std::size_t>(kGrainsPerBlock); ++k) next[k + 1] += next[k];
    out.end.assign(next + 1, next + 1 + std::min(static_cast<std::size_t>(kGrainsPerBlock), grains_ - start));
    out.partner.resize(next[kGrainsPerBlock]);
    out.rows.resize_for_overwrite(next[kGrainsPerBlock] * width_);
    for (std::size_t p = first; p < last; ++p) {
      if (!counts(p)) continue;
      const std::size_t at = next[list.own[p]]++;
      out.partner[at] = list.partner[p];
      std::copy_n(list.contacts[b].history(list.place[p], list.history_width), width_, out.rows.data() + at * width_);
    }
    list.contacts[b] = BlockContacts();
  }
}

const double* ContactEstate::history(std::size_t lower, std::size_t higher) const {
  if (lower >= grains_ || higher >= grains_) return nullptr;
  const Block& block = block_[PairList::block_of(lower)];
  const std::size_t k = lower - PairList::block_start(PairList::block_of(lower));
  for (std::uint32_t at = k == 0 ? 0 : block.end[k - 1]; at < block.end[k]; ++at)
    if (static_cast<std::size_t>(block.partner[at]) == higher) return block.rows.data() + at * width_;
  return nullptr;
}
}  // namespace venato::dem

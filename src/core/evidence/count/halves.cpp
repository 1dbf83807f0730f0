#include "self_awareness/core/evidence/count/halves.h"

#include <utility>

namespace self_awareness::core::evidence {

void joinParts(Halves& counts, std::size_t half) {
  Statistics types;
  for (const EventType& type : counts[0].vocabulary().types()) {
    types.intern(type);
  }
  counts[0].merge(counts[1]);
  counts[1] = std::move(types);
  if (half == 1) {
    std::swap(counts[0], counts[1]);
  }
}

void merge(Halves& counts, std::optional<std::size_t> only, const Halves& others,
           std::optional<std::size_t> others_only) {
  if (only && only != others_only) {
    joinParts(counts, *only);
  }
  const bool part_to_part = only == others_only;
  for (std::size_t k = 0; k < others.size(); ++k) {
    counts.at(part_to_part ? k : others_only.value_or(k)).merge(others[k]);
  }
  for (Statistics& half : counts) {
    for (const EventType& type : others[0].vocabulary().types()) {
      half.intern(type);
    }
  }
}

}  // namespace self_awareness::core::evidence

#include "self_awareness/core/evidence/count/partners.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "core/evidence/count/bin_arrays.h"

namespace self_awareness::core::evidence {
namespace {

template <typename Counts>
constexpr std::uint64_t mostOf() {
  return std::numeric_limits<typename Counts::value_type>::max();
}

template <typename Count>
Count* rowOf(std::vector<Count>& counts, std::size_t place) {
  return counts.data() + place * kDelayBins;
}

template <typename Count>
const Count* rowOf(const std::vector<Count>& counts, std::size_t place) {
  return counts.data() + place * kDelayBins;
}

}  // namespace

bool operator==(const Partner& a, const Partner& b) {
  return a.id == b.id && a.answers == b.answers && a.delays == b.delays;
}

Partner Partners::at(std::size_t place) const {
  Partner partner;
  partner.id = ids_.at(place);
  partner.answers = answers_[place];
  std::visit(
      [&](const auto& counts) {
        std::copy_n(rowOf(counts, place), kDelayBins, partner.delays.begin());
      },
      counts_);
  return partner;
}

std::optional<std::size_t> Partners::find(EventId id) const {
  if (id < ids_.size() && ids_[id] == id) {
    return id;  // if all event types are partners
  }
  const auto place = std::lower_bound(ids_.begin(), ids_.end(), id);
  return place != ids_.end() && *place == id
             ? std::optional(static_cast<std::size_t>(place - ids_.begin()))
             : std::nullopt;
}

std::uint64_t Partners::total(std::size_t place) const {
  return std::visit(
      [&](const auto& counts) {
        const auto* row = rowOf(counts, place);
        return std::accumulate(row, row + kDelayBins, std::uint64_t{0});
      },
      counts_);
}

void Partners::append(const Partner& partner) {
  if (!ids_.empty() && partner.id <= ids_.back()) {
    throw std::invalid_argument("partners of an event type must be event types, in order");
  }
  widen(*std::max_element(partner.delays.begin(), partner.delays.end()));
  ids_.push_back(partner.id);
  answers_.push_back(partner.answers);
  std::visit(
      [&](auto& counts) {
        using Count = typename std::decay_t<decltype(counts)>::value_type;
        std::transform(partner.delays.begin(), partner.delays.end(), std::back_inserter(counts),
                       [](std::uint32_t count) { return static_cast<Count>(count); });
      },
      counts_);
}

void Partners::reserve(std::size_t number) {
  ids_.reserve(number);
  answers_.reserve(number);
  std::visit([&](auto& counts) { counts.reserve(number * kDelayBins); }, counts_);
}

void Partners::makeAll(std::size_t types) {
  if (ids_.size() == types) {
    return;
  }
  if (!ids_.empty() && ids_.back() >= ids_.size()) {
    Partners none;
    none.makeAll(types);
    *this = sum(*this, none);
    return;
  }
  reserve(types);  // and no more: there may be many rows
  const auto known = static_cast<std::ptrdiff_t>(ids_.size());
  ids_.resize(types);
  std::iota(ids_.begin() + known, ids_.end(), static_cast<EventId>(known));
  answers_.resize(types);
  std::visit([&](auto& counts) { counts.resize(types * kDelayBins); }, counts_);
}

void Partners::count(const std::vector<std::uint8_t>& bins,
                     const std::vector<std::uint8_t>& came) {
  const std::size_t types = came.size();
  if (types > size() || (types == 0 ? !bins.empty() : bins.size() % types != 0)) {
    throw std::invalid_argument("an event has a bin for every event type");
  }
  if (bins.empty()) {
    return;
  }
  widen(largest_ + bins.size() / types);  // no event adds more than one to a count
  std::visit(
      [&](auto& counts) {
        for (std::size_t id = 0; id < types; ++id) {
          auto* const row = rowOf(counts, id);
          for (std::size_t k = id; k < bins.size(); k += types) {
            if (bins[k] != kNotSeen) {
              ++row[bins[k]];
            }
          }
        }
      },
      counts_);
  std::transform(came.begin(), came.end(), answers_.begin(), answers_.begin(), std::plus<>());
}

void Partners::widen(std::uint64_t largest) {
  largest_ = std::max(largest_, largest);
  const auto widenTo = [this](auto wide) {
    std::visit(
        [&](const auto& counts) {
          wide.reserve(counts.capacity());
          wide.assign(counts.begin(), counts.end());
        },
        counts_);
    counts_ = std::move(wide);
  };
  if (counts_.index() < 1 && largest_ > mostOf<Counts<std::uint8_t>>()) {
    widenTo(Counts<std::uint16_t>());
  }
  if (counts_.index() < 2 && largest_ > mostOf<Counts<std::uint16_t>>()) {
    widenTo(Counts<std::uint32_t>());
  }
}

Partners Partners::sum(const Partners& a, const Partners& b) {
  Partners both;
  both.reserve(std::max(a.size(), b.size()));
  std::size_t x = 0;
  std::size_t y = 0;
  while (x < a.size() || y < b.size()) {
    if (y == b.size() || (x < a.size() && a.id(x) < b.id(y))) {
      both.append(a.at(x++));
    } else if (x == a.size() || b.id(y) < a.id(x)) {
      both.append(b.at(y++));
    } else {
      Partner partner = a.at(x++);
      const Partner other = b.at(y++);
      partner.answers += other.answers;
      // The years of a fleet may be more than a count holds: it then stays at the largest number.
      asArray(partner.delays) +=
          asArray(other.delays)
              .min(std::numeric_limits<std::uint32_t>::max() - asArray(partner.delays));
      both.append(partner);
    }
  }
  return both;
}

}  // namespace self_awareness::core::evidence

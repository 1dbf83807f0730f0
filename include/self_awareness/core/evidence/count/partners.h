#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "self_awareness/core/evidence/count/delay_histogram.h"
#include "self_awareness/core/stream/event.h"

namespace self_awareness::core::evidence {

/// What the events of a type e count about another type.
struct Partner {
  EventId id = 0;             ///< of the other type
  std::uint64_t answers = 0;  ///< gaps between two e in which the other came
  DelayHistogram delays{};    ///< from the last event of the other to an e
};

bool operator==(const Partner& a, const Partner& b);

/// The partners of one event type, ordered by id, each once. A thousand event types have a million
/// pairs: a count takes one byte, until a delay of the type has come too often for that.
class Partners {
 public:
  /// Bin of a type that was not seen yet.
  static constexpr std::uint8_t kNotSeen = 255;

  std::size_t size() const { return ids_.size(); }
  /// A copy of one.
  /// @param place its place in the order, below size()
  Partner at(std::size_t place) const;
  /// Place of the partner with this id, if there is one.
  std::optional<std::size_t> find(EventId id) const;
  /// Number of its delays.
  /// @param place as in at()
  std::uint64_t total(std::size_t place) const;
  std::uint64_t answers(std::size_t place) const { return answers_[place]; }
  EventId id(std::size_t place) const { return ids_[place]; }

  /// @throw std::invalid_argument unless its id is above all others
  void append(const Partner& partner);
  /// Makes the types with the ids below `types` partners: the place is then the id.
  void makeAll(std::size_t types);
  /// Counts events of the type; makeAll() must have been called.
  /// @param bins of each event in turn, by id: of the delay since the last event of the other
  /// type; kNotSeen: there was none
  /// @param came by id: of how many of them the other type came since the one before
  /// @throw std::invalid_argument if bins are not those of some events
  void count(const std::vector<std::uint8_t>& bins, const std::vector<std::uint8_t>& came);
  /// The counts of both, added up.
  static Partners sum(const Partners& a, const Partners& b);

 private:
  template <typename Count>
  using Counts = std::vector<Count>;

  void reserve(std::size_t number);
  /// Makes room for counts of this size.
  void widen(std::uint64_t largest);

  std::vector<EventId> ids_;
  std::vector<std::uint64_t> answers_;
  /// kDelayBins of each partner.
  std::variant<Counts<std::uint8_t>, Counts<std::uint16_t>, Counts<std::uint32_t>> counts_;
  std::uint64_t largest_ = 0;  // that no count exceeds
};

}  // namespace self_awareness::core::evidence

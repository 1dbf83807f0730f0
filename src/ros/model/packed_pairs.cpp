#include "packed_pairs.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "check.h"

namespace self_awareness::ros1 {
namespace {

namespace evidence = core::evidence;

constexpr char kOther[] = "its evidence does not fit its event types";
constexpr unsigned kBits = 7;
constexpr std::uint8_t kMore = 1U << kBits;
constexpr std::size_t kBitsOfByte = 8;

void pack(std::uint64_t number, std::vector<std::uint8_t>& bytes) {
  for (; number >= kMore; number >>= kBits) {
    bytes.push_back(static_cast<std::uint8_t>(number) | kMore);
  }
  bytes.push_back(static_cast<std::uint8_t>(number));
}

/// Takes one number after the other.
class Numbers {
 public:
  explicit Numbers(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  bool done() const { return next_ == bytes_.size(); }
  /// @throw std::invalid_argument if there is none, or it is larger
  std::uint64_t take(std::uint64_t largest) {
    std::uint64_t number = 0;
    for (unsigned shift = 0;; shift += kBits) {
      check(next_ < bytes_.size() && shift + kBits < std::numeric_limits<std::uint64_t>::digits,
            kOther);
      const std::uint8_t byte = bytes_[next_++];
      number |= static_cast<std::uint64_t>(byte % kMore) << shift;
      if (byte < kMore) {
        break;
      }
    }
    check(number <= largest, kOther);
    return number;
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  std::size_t next_ = 0;
};

bool isFilled(std::uint32_t count) {
  return count > 0;
}

}  // namespace

self_awareness::PackedPairs packedPairs(const evidence::Statistics& statistics, core::EventId id) {
  self_awareness::PackedPairs message;
  message.id = id;
  const evidence::Partners& partners = statistics.partners(id);
  std::size_t next = 0;
  for (std::size_t k = 0; k < partners.size(); ++k) {
    const evidence::Partner partner = partners.at(k);
    const auto first = std::find_if(partner.delays.begin(), partner.delays.end(), isFilled);
    const auto end =
        std::find_if(partner.delays.rbegin(), std::make_reverse_iterator(first), isFilled).base();
    if (first == end && partner.answers == 0) {
      continue;
    }
    pack(partner.id - next, message.others);
    next = partner.id + 1;
    pack(partner.answers, message.others);
    pack(static_cast<std::uint64_t>(first - partner.delays.begin()), message.others);
    pack(static_cast<std::uint64_t>(end - first), message.others);
    std::for_each(first, end, [&](std::uint32_t count) { pack(count, message.others); });
  }
  const evidence::SumOfDelays& left_out = statistics.type(id).left_out;
  if (left_out != evidence::SumOfDelays{}) {
    message.left_out.assign(left_out.begin(), left_out.end());
  }
  for (core::EventId from = 0; from < statistics.size(); ++from) {
    if (statistics.leftOut().contains(id, from)) {
      message.left_out_pairs.resize(from / kBitsOfByte + 1);
      message.left_out_pairs.back() |= static_cast<std::uint8_t>(1U << from % kBitsOfByte);
    }
  }
  return message;
}

void setPairs(const self_awareness::PackedPairs& message, evidence::Statistics& statistics) {
  const std::size_t types = statistics.size();
  check(message.id < types, kOther);
  evidence::Partners partners;
  Numbers numbers(message.others);
  for (core::EventId next = 0; !numbers.done(); ++next) {
    evidence::Partner partner;
    partner.id = next + static_cast<core::EventId>(numbers.take(types - 1));
    check(partner.id < types, kOther);
    partner.answers = numbers.take(std::numeric_limits<std::int64_t>::max());
    const std::uint64_t first = numbers.take(evidence::kDelayBins);
    const std::uint64_t end = first + numbers.take(evidence::kDelayBins);
    check(end <= evidence::kDelayBins, "its evidence has an impossible bin");
    for (std::uint64_t bin = first; bin < end; ++bin) {
      partner.delays[bin] =
          static_cast<std::uint32_t>(numbers.take(std::numeric_limits<std::uint32_t>::max()));
    }
    partners.append(partner);
    next = partner.id;
  }
  statistics.setPartners(message.id, std::move(partners));
  check(statistics.total(message.id, message.id) <= statistics.type(message.id).gaps,
        "its evidence has more delays than gaps");
  check(message.left_out.empty() || message.left_out.size() == evidence::kDelayBins, kOther);
  evidence::SumOfDelays& left_out = statistics.type(message.id).left_out;
  left_out.fill(0);
  std::copy(message.left_out.begin(), message.left_out.end(), left_out.begin());
  for (std::size_t k = 0; k < message.left_out_pairs.size() * kBitsOfByte; ++k) {
    if ((message.left_out_pairs[k / kBitsOfByte] >> k % kBitsOfByte & 1U) != 0) {
      check(k < types, kOther);
      statistics.leaveOut(static_cast<core::EventId>(k), message.id);
    }
  }
}

}  // namespace self_awareness::ros1

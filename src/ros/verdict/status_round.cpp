#include "status_round.h"

#include <ros/serialization.h>

#include <algorithm>
#include <set>

#include "status_lists.h"

namespace self_awareness::ros1 {
namespace {

using diagnostic_msgs::DiagnosticStatus;

// What a quiet time saves, and what many changes at once take in advance [s].
constexpr double kSaved = 1;
constexpr double kAdvance = 30;
// What is not OK is said after so long [s], so many of them with a report.
constexpr double kUrgentAfter = 5;
constexpr std::size_t kUrgent = 2;
// Everybody has his turn within so long [s]; reports may be late.
constexpr double kRound = 50;

}  // namespace

std::size_t bytesOf(const DiagnosticStatus& status) {
  return ros::serialization::serializationLength(status);
}

std::vector<DiagnosticStatus> StatusRound::next(const std::vector<DiagnosticStatus>& all,
                                                std::size_t others, double elapsed) {
  left_ = std::min(left_ + bytes_per_second_ * elapsed, kSaved * bytes_per_second_) -
          static_cast<double>(others);
  std::vector<DiagnosticStatus> chosen;
  std::set<std::string> names;
  const auto send = [&](const DiagnosticStatus& status) {
    if (names.insert(status.name).second) {
      left_ -= static_cast<double>(bytesOf(status));
      said_[status.name] = {status.level, 0, withoutNumbers(status.message)};
      chosen.push_back(status);
    }
  };
  for (auto& [name, said] : said_) {
    said.since += elapsed;
  }
  for (const DiagnosticStatus& status : all) {
    const auto said = said_.find(status.name);
    if (said == said_.end() || said->second.level != status.level ||
        said->second.words != withoutNumbers(status.message)) {
      send(status);
    }
  }
  for (std::size_t i = 0; i < kUrgent; ++i) {
    const DiagnosticStatus* oldest = nullptr;
    for (const DiagnosticStatus& status : all) {
      const double since = said_[status.name].since;
      if (status.level != DiagnosticStatus::OK && since >= kUrgentAfter &&
          (oldest == nullptr || since > said_[oldest->name].since)) {
        oldest = &status;
      }
    }
    if (oldest != nullptr) {
      send(*oldest);
    }
  }
  std::size_t at = 0;
  while (at < all.size() && all[at].name != last_) {
    ++at;
  }
  const auto number = static_cast<double>(all.size());
  due_ = std::min(due_ + number * elapsed / kRound, number);
  for (std::size_t i = 1; i <= all.size() && (left_ > 0 || due_ >= 1); ++i) {
    const DiagnosticStatus& status = all[(at + i) % all.size()];
    send(status);
    last_ = status.name;
    due_ = std::max(due_ - 1, 0.0);
  }
  left_ = std::max(left_, -kAdvance * bytes_per_second_);
  return chosen;
}

}  // namespace self_awareness::ros1

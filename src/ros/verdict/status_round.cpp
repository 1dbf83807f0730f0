#include "status_round.h"

#include <re2/re2.h>
#include <ros/serialization.h>

#include <algorithm>
#include <set>
#include <utility>

#include "../text.h"

namespace self_awareness::ros1 {
namespace {

constexpr std::size_t kMostListed = 20;
constexpr std::size_t kMostBytes = 300;
constexpr std::size_t kFewBytes = 100;
constexpr double kEvery = 20;  // [s]

// How many items from the first on a number of bytes holds; one at least.
std::size_t fitting(const std::vector<std::string>& list, std::size_t most) {
  std::size_t bytes = 0;
  std::size_t items = 0;
  while (items < list.size() && items < kMostListed) {
    bytes += list[items].size() + 2;
    if (items > 0 && bytes > most) {
      break;
    }
    ++items;
  }
  return items;
}

// An item may be as long as a stranger's name.
std::string cut(const std::string& item) {
  return shortened(item, kMostBytes);
}

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

std::string listed(const std::vector<std::string>& list) {
  const std::size_t told = fitting(list, kMostBytes);
  std::string text;
  for (std::size_t i = 0; i < told; ++i) {
    text += (i > 0 ? ", " : "") + cut(list[i]);
  }
  return told < list.size() ? text + " and " + std::to_string(list.size() - told) + " more" : text;
}

void tellList(const std::string& key, const std::vector<std::string>& list, ListsAre lists,
              diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::string text = listed(list);
  if (lists == ListsAre::kCounted && list.size() > 1 && text.size() > kFewBytes) {
    status.add(key, std::to_string(list.size()) + ", listed every 20 s");
  } else if (!list.empty()) {
    status.add(key, text);
  }
}

void tellNumbered(const std::string& key, const std::vector<std::string>& list, ListsAre lists,
                  diagnostic_updater::DiagnosticStatusWrapper& status) {
  const std::size_t told = fitting(list, lists == ListsAre::kTold ? kMostBytes : kFewBytes);
  for (std::size_t i = 0; i < told; ++i) {
    status.add(key + " " + std::to_string(i + 1), cut(list[i]));
  }
  if (told < list.size()) {
    status.add("further " + key, list.size() - told);
  }
}

ListsAre ListRound::next(const std::string& lists, double elapsed) {
  since_ += elapsed;
  std::string now = withoutNumbers(lists);
  if (now == told_ && since_ < kEvery) {
    return ListsAre::kCounted;
  }
  told_ = std::move(now);
  since_ = 0;
  return ListsAre::kTold;
}

std::string withoutNumbers(std::string text) {
  static const re2::RE2 kNumber("[0-9]+(\\.[0-9]+)*");
  re2::RE2::GlobalReplace(&text, kNumber, "0");
  return text;
}

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

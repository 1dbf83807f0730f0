#include "restarts.h"

#include <algorithm>

namespace self_awareness {
namespace {

constexpr std::size_t kMostCounted = 100;
constexpr std::int64_t kMinute = 60'000'000'000;

}  // namespace

std::vector<std::string> Restarts::see(const std::map<std::string, std::string>& addresses,
                                       std::int64_t now, const std::string& when) {
  std::vector<std::string> restarted;
  for (const auto& [name, address] : addresses) {
    const auto known = nodes_.find(name);
    if (known == nodes_.end()) {
      if (nodes_.size() < kMostNodes) {
        nodes_[name].address = address;
      }
      continue;
    }
    Node& node = known->second;
    if (address.empty() || node.address == address) {
      continue;
    }
    node.address = address;
    node.restarts.push_back(now);
    while (node.restarts.size() > kMostCounted || node.restarts.front() < now - kSpan) {
      node.restarts.pop_front();
    }
    node.when = when;
    node.waits = true;
    node.heard.reset();
    restarted.push_back(name);
  }
  return restarted;
}

void Restarts::onHeard(const std::string& node, std::int64_t now) {
  const auto known = nodes_.find(node);
  if (known != nodes_.end() && known->second.waits && !known->second.heard) {
    known->second.heard = now;
  }
}

std::vector<std::string> Restarts::advance(std::int64_t now,
                                           const std::set<std::string>& abnormal) {
  std::vector<std::string> lines;
  for (auto& [name, node] : nodes_) {
    if (node.waits && node.heard && now >= *node.heard + settle_time_ &&
        abnormal.count(name) == 0) {
      node.waits = false;
      const std::size_t times = count(name, now);
      lines.push_back(name + " restarted at " + node.when + ", back as usual" +
                      (times > 1 ? "; " + inWords(name, now) : ""));
    }
  }
  return lines;
}

void Restarts::onClockSet() {
  for (auto& [name, node] : nodes_) {
    node.restarts.clear();
    node.waits = false;
  }
}

std::size_t Restarts::count(const std::string& node, std::int64_t now) const {
  const auto known = nodes_.find(node);
  return known == nodes_.end() ? 0
                               : static_cast<std::size_t>(std::count_if(
                                     known->second.restarts.begin(), known->second.restarts.end(),
                                     [&](std::int64_t at) { return at >= now - kSpan; }));
}

std::string Restarts::inWords(const std::string& node, std::int64_t now) const {
  const std::size_t times = count(node, now);
  return times == 0 ? ""
                    : "restarted " + std::to_string(times) + (times == 1 ? " time" : " times") +
                          " in " + std::to_string(kSpan / kMinute) + " min";
}

}  // namespace self_awareness

#include "restarts.h"

#include <algorithm>

#include "self_awareness/ros/stable_name.h"

namespace self_awareness {
namespace {

constexpr std::size_t kMostCounted = 100;
constexpr std::int64_t kMinute = 60'000'000'000;

}  // namespace

std::vector<std::string> Restarts::see(const std::map<std::string, std::string>& addresses,
                                       const ros1::Encoder& encoder, std::int64_t now,
                                       const std::string& when) {
  std::set<std::string> restarted;
  for (const auto& [node, address] : addresses) {
    if (address.empty() || !encoder.includesSource(ros1::stableName(node))) {
      continue;
    }
    const auto known = addresses_.find(node);
    if (known == addresses_.end()) {
      if (addresses_.size() < kMostNodes) {
        addresses_[node] = address;
      }
    } else if (known->second != address) {
      known->second = address;
      restarted.insert(encoder.sourceOf(node));
    }
  }
  for (const std::string& name : restarted) {
    Source& source = sources_[name];
    source.restarts.push_back(now);
    while (source.restarts.size() > kMostCounted || source.restarts.front() < now - kSpan) {
      source.restarts.pop_front();
    }
    source.when = when;
    source.waits = true;
    source.heard.reset();
  }
  return {restarted.begin(), restarted.end()};
}

void Restarts::onHeard(const std::string& source, std::int64_t now) {
  const auto known = sources_.find(source);
  if (known != sources_.end() && known->second.waits && !known->second.heard) {
    known->second.heard = now;
  }
}

std::vector<std::string> Restarts::advance(std::int64_t now,
                                           const std::set<std::string>& abnormal) {
  std::vector<std::string> lines;
  for (auto& [name, source] : sources_) {
    if (source.waits && source.heard && now >= *source.heard + settle_time_ &&
        abnormal.count(name) == 0) {
      source.waits = false;
      const std::size_t times = count(name, now);
      lines.push_back(name + " restarted at " + source.when + ", back as usual" +
                      (times > 1 ? "; " + inWords(name, now) : ""));
    }
  }
  return lines;
}

void Restarts::onClockSet() {
  for (auto& [name, source] : sources_) {
    source.restarts.clear();
    source.waits = false;
  }
}

std::size_t Restarts::count(const std::string& source, std::int64_t now) const {
  const auto known = sources_.find(source);
  return known == sources_.end()
             ? 0
             : static_cast<std::size_t>(
                   std::count_if(known->second.restarts.begin(), known->second.restarts.end(),
                                 [&](std::int64_t at) { return at >= now - kSpan; }));
}

std::string Restarts::inWords(const std::string& source, std::int64_t now) const {
  const std::size_t times = count(source, now);
  return times == 0 ? ""
                    : "restarted " + std::to_string(times) + (times == 1 ? " time" : " times") +
                          " in " + std::to_string(kSpan / kMinute) + " min";
}

}  // namespace self_awareness

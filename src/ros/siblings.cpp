#include "self_awareness/ros/siblings.h"

namespace self_awareness::ros1 {
namespace {

constexpr char kPackage[] = "self_awareness/";

}  // namespace

bool isOwnType(const std::string& datatype) {
  return datatype.rfind(kPackage, 0) == 0;
}

void Siblings::add(const std::string& node, const std::string& datatype) {
  if (!node.empty() && isOwnType(datatype)) {
    nodes_.insert(node);
  }
}

bool Siblings::mayCover(const std::string& topic) {
  return topic == "/rosout" || topic == "/diagnostics";
}

bool Siblings::cover(const std::string& node, const std::string& topic) const {
  return mayCover(topic) && nodes_.count(node) > 0;
}

}  // namespace self_awareness::ros1

#include <nodelet/nodelet.h>

#include <exception>
#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "monitor.h"

namespace self_awareness {

/// The monitor as a nodelet. A manager of its own is the default: in the robot's manager, its
/// subscriptions force publishers to serialize messages that they could hand on by pointer.
class SelfAwarenessNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      monitor_ = std::make_unique<Monitor>(getNodeHandle(), getPrivateNodeHandle(), getName());
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());  // the manager says only that it failed
      throw;
    }
  }

  std::unique_ptr<Monitor> monitor_;
};

}  // namespace self_awareness

PLUGINLIB_EXPORT_CLASS(self_awareness::SelfAwarenessNodelet, nodelet::Nodelet)

#include "run_node.h"

#include <ros/names.h>
#include <ros/ros.h>
#include <ros/service_manager.h>
#include <ros/this_node.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string_view>
#include <thread>

#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/guarded.h"

namespace self_awareness {
namespace {

constexpr std::chrono::seconds kGoodbye(2);
constexpr std::chrono::hours kUntilTold(1);      // to wait for what notifies
constexpr timespec kBetweenLooks{0, 100000000};  // at whether the node has ended without a signal

/// How far a node is; what is true stays true.
struct Life {
  bool connected = false;  // the master has answered
  bool made = false;
  bool stopping = false;
  bool finished = false;
  bool gone = false;
  int exit_code = 0;
};

/// Ends the process when the master keeps a node from leaving. Takes the signals, too, in a thread
/// of its own: roscpp's handler would close the connections while the node's threads use them.
class Leaving {
 public:
  Leaving() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);  // all later threads take this over
    signal_thread_ = std::thread([this] { awaitSignal(); });
    goodbye_thread_ = std::thread([this] { limitGoodbye(); });
  }
  ~Leaving() {
    change([](Life& life) { life.stopping = life.finished = life.gone = true; });
    signal_thread_.join();
    goodbye_thread_.join();
  }

  template <typename Change>
  void change(Change change) {
    {
      const auto life = life_.lock();
      change(*life);
    }
    changed_.notify_all();
  }
  /// Waits until this is so; returns false if it is not within that time.
  template <typename Condition>
  bool await(Condition condition, std::chrono::duration<double> time) {
    auto life = life_.lock();
    life.waitFor(changed_, time, condition);
    return condition(*life);
  }

 private:
  void awaitSignal() {
    while (!life_.lock()->stopping) {
      if (sigtimedwait(&signals_, nullptr, &kBetweenLooks) > 0) {
        if (!life_.lock()->connected) {
          ros::requestShutdown();  // else roscpp waits for the master until it comes
        }
        change([](Life& life) { life.stopping = true; });
      }
    }
  }

  void limitGoodbye() {
    // What is not made yet has nothing to lose.
    const auto may_go = [](const Life& life) {
      return life.stopping && (life.finished || !life.made);
    };
    while (!await(may_go, kUntilTold)) {
    }
    if (!await([](const Life& life) { return life.gone; }, kGoodbye)) {
      std::fputs("the master does not answer: this node ends without unregistering\n", stderr);
      std::fflush(stdout);
      std::_Exit(life_.lock()->exit_code);
    }
  }

  sigset_t signals_;
  ros1::Guarded<Life> life_;
  std::condition_variable changed_;
  std::thread signal_thread_;
  std::thread goodbye_thread_;
};

// With the log4cxx of Debian 12, rosconsole frees all loggers once it has listed them, and the
// next one that is looked for ends the process.
void withdrawListOfLoggers() {
#if __has_include(<log4cxx/log4cxx.h>)
  ros::ServiceManager::instance()->unadvertiseService(
      ros::names::append(ros::this_node::getName(), "get_loggers"));
#endif
}

Leaving* leaving = nullptr;  // of the node that runs

void run(const std::function<std::unique_ptr<NodeProgram>()>& make) {
  const std::unique_ptr<NodeProgram> made = make();
  leaving->change([](Life& life) { life.made = true; });
  const auto stopping = [](const Life& life) { return life.stopping; };
  while (ros::ok() && !leaving->await(stopping, std::chrono::milliseconds(100))) {
  }
  made->finish();
  leaving->change([](Life& life) { life.stopping = life.finished = true; });
}

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const std::string& usage,
            const std::function<std::unique_ptr<NodeProgram>()>& make) {
  const std::string_view asked = argc > 1 ? argv[1] : "";
  if (asked == "--version") {
    std::printf("self_awareness %s\n", ros1::kPackageVersion);
    return 0;
  }
  if (asked == "--help" || asked == "-h") {
    std::printf("%s\n", usage.c_str());
    return 0;
  }
  Leaving this_leaving;
  leaving = &this_leaving;
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  const ros::NodeHandle node_handle;  // waits for the master, and outlives what is made
  withdrawListOfLoggers();
  leaving->change([](Life& life) { life.connected = true; });
  try {
    run(make);
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    leaving->change([](Life& life) {
      life.exit_code = 1;
      life.stopping = life.finished = true;
    });
    return 1;
  }
  return 0;
}

void endNode() {
  leaving->change([](Life& life) { life.stopping = true; });
}

}  // namespace self_awareness

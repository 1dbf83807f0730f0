#include "self_awareness/ros/live/subscriptions.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "../now.h"
#include "publisher_table.h"

namespace self_awareness::ros1 {
namespace {

constexpr int kBetweenLooks = 50;  // [ms]

int makeBell() {
  const int bell = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (bell < 0) {
    throw std::system_error(errno, std::generic_category(), "cannot listen to publishers");
  }
  return bell;
}

}  // namespace

Subscriptions::Subscriptions(Arrivals& arrivals, const ReadLimits& limits)
    : wake_(makeBell()),
      table_(std::make_unique<PublisherTable>(arrivals, limits)),
      thread_([this] { run(); }) {}

Subscriptions::~Subscriptions() {
  shared_.lock()->stopping = true;
  wake();
  thread_.join();
  table_.reset();
  close(wake_);
}

void Subscriptions::listen(Listening listening) {
  shared_.lock()->listening = std::make_shared<const Listening>(std::move(listening));
  wake();
}

void Subscriptions::wake() const {
  eventfd_write(wake_, 1);
}

void Subscriptions::run() {
  std::vector<pollfd> sockets;
  while (true) {
    std::shared_ptr<const Listening> listening;
    {
      const auto shared = shared_.lock();
      if (shared->stopping) {
        return;
      }
      listening = std::exchange(shared->listening, nullptr);
    }
    const std::int64_t now = steadyNow();
    if (listening) {
      table_->setListening(*listening, now);
    }
    table_->attend(now);
    std::vector<Unheard> unheard = table_->unheard(now);
    shared_.lock()->unheard = std::move(unheard);
    sockets.assign(1, {wake_, POLLIN, 0});
    table_->sockets(sockets);
    if (poll(sockets.data(), sockets.size(), kBetweenLooks) > 0) {
      eventfd_t rings = 0;
      eventfd_read(wake_, &rings);
      table_->advance(steadyNow());
    }
  }
}

}  // namespace self_awareness::ros1

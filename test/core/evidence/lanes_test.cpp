#include "core/evidence/lanes.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <vector>

#include "tracks.h"

namespace self_awareness::core::evidence {
namespace {

class LanesTest : public testing::Test {
 protected:
  Shares sharesOf(std::size_t track, double share) {
    tracks_ = allTracks(*model_, 0);
    tracks_.at(track) = share;
    return {tracks_, {}};
  }
  std::size_t track(const std::string& channel, EventId to, EventId from) const {
    return indexOf(model_->tracks(), channel, to, from);
  }
  std::size_t component(EventId id) const { return model_->componentIndex(id); }
  static Window windowAt(std::int64_t start) {
    Window window;
    window.start = start;
    return window;
  }

  std::shared_ptr<const Model> model_ =
      std::make_shared<Model>(watch(startOf(followed(1), 1), startOf(followed(2), 2)));
  std::vector<double> tracks_;
};

TEST_F(LanesTest, AColumnKeepsTheLargestOfItsWindows) {
  Lanes lanes(model_, {0, 2 * kWindow});
  const std::size_t overdue = track(kOverdue, kA, kA);
  const std::size_t delay = track(kPairs, kB, kA);
  lanes.add(windowAt(-kWindow), sharesOf(overdue, 9));  // before all columns
  lanes.add(windowAt(0), sharesOf(overdue, 0.5));
  lanes.add(windowAt(kWindow), sharesOf(delay, 1.5));
  lanes.add(windowAt(2 * kWindow), sharesOf(overdue, 0.25));
  lanes.add(windowAt(9 * kWindow), {tracks_, {{kB, 0.125}}});
  const std::vector<Lanes::Column>& columns = lanes.columns();
  ASSERT_EQ(columns.size(), 2);
  EXPECT_EQ(columns[0].shares[component(kA)], 0.5F);
  EXPECT_EQ(columns[0].shares[component(kB)], 1.5F);
  EXPECT_EQ(columns[0].strongest_share, 1.5F);
  EXPECT_EQ(columns[0].track, delay);
  EXPECT_EQ(columns[1].shares[component(kA)], 0.25F);
  EXPECT_EQ(columns[1].shares[component(kB)], 0.125F);  // never heard
  EXPECT_THROW(Lanes(model_, {1, 0}), std::invalid_argument) << "stretches are in order";
}

}  // namespace
}  // namespace self_awareness::core::evidence

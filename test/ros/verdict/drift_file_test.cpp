#include "ros/verdict/drift_file.h"

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "ros/verdict/incidents_file.h"
#include "ros/verdict/one_message_file.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {
namespace {

namespace fs = boost::filesystem;

class DriftFileTest : public testing::Test {
 protected:
  DriftFileTest() {
    fs::create_directory(folder_);
    drift_.model = 5;
    drift_.components = {"/driver", "/base"};
    drift_.shares = {0.1, 0.2, 0.3, 0.4};
    drift_.run_id = "4711";
    drift_.end = 1600000000000000001;
  }
  ~DriftFileTest() override { fs::remove_all(folder_); }
  DriftFileTest(const DriftFileTest&) = delete;
  DriftFileTest& operator=(const DriftFileTest&) = delete;

  std::string written() {
    writeDrift(drift_, path_);
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Why the file is refused; empty: it is not.
  std::string error() const {
    try {
      readDrift(path_);
      return "";
    } catch (const BagError& error) {
      return error.what();
    }
  }
  /// The same of a file with what drift_ is now.
  std::string errorOfIt() {
    writeDrift(drift_, path_);
    return error();
  }

  const fs::path folder_ = fs::temp_directory_path() / fs::unique_path();
  const std::string path_ = pathOfDrift((folder_ / "robot.model").string());
  self_awareness::KeptDrift drift_;
};

TEST_F(DriftFileTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(readDrift(path_)) << "there is no file";
  written();
  EXPECT_EQ(readDrift(path_), drift_);
  drift_.shares.clear();
  written();
  EXPECT_EQ(readDrift(path_), drift_) << "no sample yet";
}

TEST_F(DriftFileTest, ADamagedFileIsRefusedByName) {
  const std::string good = written();
  for (std::size_t size = 0; size < good.size(); size += 41) {
    std::ofstream(path_, std::ios::binary) << good.substr(0, size);
    EXPECT_EQ(error().rfind(path_ + ": ", 0), 0U) << size;
  }
}

TEST_F(DriftFileTest, WhatCannotBeIsRefused) {
  drift_.shares.push_back(0.5);
  EXPECT_NE(errorOfIt().find("(a sample has a share of each component)"), std::string::npos);
  for (const double share : {-0.5, std::nan(""), HUGE_VAL}) {
    drift_.shares = {share, 0.5};
    EXPECT_NE(errorOfIt().find("(a share is none)"), std::string::npos) << share;
  }
  drift_.shares.assign(2 * (kMostDriftSamples + 1), 0.5);
  EXPECT_NE(errorOfIt().find("(there are too many samples)"), std::string::npos);
  drift_.shares.resize(2 * kMostDriftSamples);
  EXPECT_EQ(errorOfIt(), "");
  drift_.run_id = std::string(1001, 'a');
  EXPECT_NE(errorOfIt().find("(a name is too long)"), std::string::npos);
  drift_.components.clear();
  EXPECT_NE(errorOfIt().find("(it is of no component)"), std::string::npos);
}

TEST_F(DriftFileTest, AFileOfAnotherKindIsNone) {
  writeIncidents({}, path_);
  EXPECT_THROW(readDrift(path_), BagError);
}

}  // namespace
}  // namespace self_awareness::ros1

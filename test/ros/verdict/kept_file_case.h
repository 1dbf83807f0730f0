#pragma once

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <fstream>
#include <iterator>
#include <string>

#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {

/// A file that the monitor keeps for another start, in a folder of its own.
class KeptFileTest : public testing::Test {
 protected:
  KeptFileTest() { boost::filesystem::create_directory(folder_); }
  ~KeptFileTest() override { boost::filesystem::remove_all(folder_); }
  KeptFileTest(const KeptFileTest&) = delete;
  KeptFileTest& operator=(const KeptFileTest&) = delete;

  virtual void write() = 0;
  virtual void read() = 0;

  /// What is written.
  std::string written() {
    write();
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Why a file with these bytes is refused; empty: it is not.
  std::string errorOf(const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    try {
      read();
      return "";
    } catch (const BagError& error) {
      return error.what();
    }
  }
  /// A file that is cut is refused by its name; of one with a changed byte, whatever it is, it is
  /// said or read.
  void expectNoBeliefInDamage() {
    const std::string good = written();
    ASSERT_EQ(errorOf(good), "");
    for (std::size_t size = 0; size < good.size(); size += 37) {
      EXPECT_EQ(errorOf(good.substr(0, size)).rfind(path_ + ": ", 0), 0U) << size;
    }
    for (std::size_t place = 0; place < good.size(); place += 11) {
      std::string bad = good;
      bad[place] = static_cast<char>(bad[place] ^ 0xff);
      errorOf(bad);
    }
    EXPECT_NE(errorOf("no bag"), "");
    EXPECT_NE(errorOf(std::string(17U << 20U, 'x')), "");
  }

  const boost::filesystem::path folder_ =
      boost::filesystem::temp_directory_path() / boost::filesystem::unique_path();
  const std::string path_ = (folder_ / "kept").string();
};

}  // namespace self_awareness::ros1

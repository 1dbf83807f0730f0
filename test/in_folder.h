#pragma once

#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <set>
#include <string>

#include "files.h"

namespace self_awareness {

/// A test with a folder of its own, which goes with it.
class InFolder : public testing::Test {
 protected:
  InFolder() { boost::filesystem::create_directory(folder_); }
  ~InFolder() override { boost::filesystem::remove_all(folder_); }
  InFolder(const InFolder&) = delete;
  InFolder& operator=(const InFolder&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// What is in the folder, or in one that is in it.
  std::set<std::string> names(const std::string& folder = "") const {
    std::set<std::string> names;
    for (const auto& entry : boost::filesystem::directory_iterator(folder_ / folder)) {
      names.insert(entry.path().filename().string());
    }
    return names;
  }

  const boost::filesystem::path folder_ =
      boost::filesystem::temp_directory_path() /
      boost::filesystem::unique_path("self_awareness-%%%%%%%%");
};

}  // namespace self_awareness

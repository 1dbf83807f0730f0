#pragma once

#include <functional>
#include <string>

#include "../../in_folder.h"
#include "../../problem.h"
#include "self_awareness/ros/bag/bag_reader.h"

namespace self_awareness::ros1 {

/// A file of one message that a test writes, changes and reads again.
template <typename Content>
class OneMessageTest : public InFolder {
 protected:
  using Write = void (*)(const Content& content, const std::string& path);

  /// @param damaged what is said of a file whose content cannot be
  OneMessageTest(Write write, std::function<void(const std::string& path)> read,
                 std::string damaged)
      : write_(write), read_(std::move(read)), damaged_(std::move(damaged)) {}

  /// Writes the file. @return its bytes
  std::string written() const {
    write_(content_, path_);
    return readFile(path_);
  }
  /// Why the file that is there is refused; empty: it is not.
  std::string error() const {
    return problemOf<BagError>([this] { read_(path_); });
  }
  /// The same of a file with these bytes.
  std::string errorOf(const std::string& bytes) const {
    writeFile(path_, bytes);
    return error();
  }
  void expectRefused(const std::string& why, const std::function<void(Content&)>& change) {
    const Content before = content_;
    change(content_);
    EXPECT_EQ(errorOf(written()), path_ + ": " + damaged_ + " (" + why + ")");
    content_ = before;
  }

  const std::string path_ = path("one.bag");
  Content content_;

 private:
  Write write_;
  std::function<void(const std::string&)> read_;
  std::string damaged_;
};

}  // namespace self_awareness::ros1

#pragma once

#include <stdexcept>
#include <string>

namespace self_awareness::ros1 {

/// A file that cannot be written; the message names it and says why.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Why a file cannot be written, in one line: "FILE: cannot be written (No space left on device,
/// there is room for 1.2 MB)".
/// @param error as in errno
/// @param temporary what was written so far, if it is removed after that; empty: nothing
std::string writeProblem(const std::string& path, int error, const std::string& temporary = "");

/// Looks whether there is a folder for files that are written later, and says the way out if not:
/// the same words each time.
/// @param path of such a file, or the beginning of it
/// @throw FileError if there is none
void checkFolder(const std::string& path);

/// Gives a file that was written its final name, in the place of a file that has it. Its content
/// is on the disk before, so that a power cut leaves the one file or the other.
/// @throw FileError if that fails; both files are as they were then
void putInPlace(const std::string& written, const std::string& path);

/// A file that is written whole or not at all: whoever writes it writes a temporary file in the
/// same folder, which takes the place of the other at the end.
///
/// A symbolic link stays one: the file that it leads to is replaced. A device or a pipe is written
/// directly. What killed programs left in the folder is removed: the temporary files that nobody
/// has locked (flock).
class OutputFile {
 public:
  /// @throw FileError if the file cannot be written there
  explicit OutputFile(const std::string& path);
  /// Removes what was not completed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// What is to be written. Its name ends like that of the file: the ending may say the format.
  const std::string& temporary() const { return temporary_; }
  /// Puts it in place.
  /// @throw FileError if that fails
  void complete();
  /// Removes it, unless it is complete.
  void close();

 private:
  void openTemporary();

  std::string path_;    // as it was named, for messages
  std::string target_;  // where its links lead; empty: it is written directly
  std::string temporary_;
  int lock_ = -1;  // file descriptor of the temporary file; -1: there is none
};

}  // namespace self_awareness::ros1

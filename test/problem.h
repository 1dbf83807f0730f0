#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace self_awareness {

/// What the error says that something ends with; empty: it goes well.
template <typename Error = std::invalid_argument, typename Action>
std::string problemOf(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Whether a text has this in it.
inline testing::AssertionResult has(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "no '" << part << "' in: " << text;
}

/// Whether a text begins so.
inline testing::AssertionResult begins(const std::string& text, const std::string& so) {
  if (text.compare(0, so.size(), so) == 0) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "not '" << so << "' begins: " << text;
}

}  // namespace self_awareness

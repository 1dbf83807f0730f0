#include "parameter_reader.h"

#include <ros/console.h>
#include <ros/param.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <boost/algorithm/string/join.hpp>
#include <cmath>
#include <sstream>

namespace self_awareness {
namespace {

using XmlRpc::XmlRpcValue;

std::string inWords(const ParameterReader::Range& range) {
  std::ostringstream words;
  words.precision(15);  // all digits of what a person would write
  words << "from " << range.least << " to " << range.most;
  return words.str();
}

bool contains(const ParameterReader::Range& range, double value) {
  return value >= range.least && value <= range.most;  // false for NaN
}

}  // namespace

template <typename T>
void ParameterReader::log(const std::string& name, const T& value) const {
  ROS_INFO_STREAM(node_handle_.resolveName(name) << ": " << value);
}

template <typename T>
T ParameterReader::read(const std::string& name, T otherwise, XmlRpcValue::Type type,
                        const std::string& must_be) {
  known_.insert(name);
  XmlRpcValue value;
  if (node_handle_.getParam(name, value)) {
    if (value.getType() != type) {
      fail(name, value, must_be);
    }
    otherwise = static_cast<T>(value);
  }
  log(name, otherwise);
  return otherwise;
}

std::string ParameterReader::text(const std::string& name, const std::string& otherwise,
                                  const std::string& must_be) {
  return read(name, otherwise, XmlRpcValue::TypeString, must_be);
}

bool ParameterReader::flag(const std::string& name, bool otherwise) {
  return read(name, otherwise, XmlRpcValue::TypeBoolean, "true or false");
}

std::vector<std::string> ParameterReader::names(const std::string& name) {
  constexpr char kMustBe[] =
      "a list of names of nodes or topics; each begins with a /, and may end with a *";
  known_.insert(name);
  std::vector<std::string> names;
  XmlRpcValue value;
  if (node_handle_.getParam(name, value)) {
    if (value.getType() != XmlRpcValue::TypeArray) {
      fail(name, value, kMustBe);
    }
    for (int i = 0; i < value.size(); ++i) {
      const bool is_text = value[i].getType() == XmlRpcValue::TypeString;
      const std::string text = is_text ? static_cast<std::string>(value[i]) : "";
      if (text.empty() || text[0] != '/' || text.find('*') < text.size() - 1) {
        fail(name, value, kMustBe);
      }
      names.push_back(text);
    }
  }
  log(name, "[" + boost::algorithm::join(names, ", ") + "]");
  return names;
}

double ParameterReader::number(const std::string& name, double otherwise, const Range& range,
                               const std::string& unit) {
  const std::string must_be = "a number of " + unit + " " + inWords(range);
  const double number = readNumber(name, otherwise, must_be);
  if (!contains(range, number)) {
    fail(name, number, must_be);
  }
  log(name, number);
  return number;
}

int ParameterReader::wholeNumber(const std::string& name, int otherwise, const Range& range) {
  const std::string must_be = "a whole number " + inWords(range);
  const double number = readNumber(name, otherwise, must_be);
  if (!contains(range, number) || std::floor(number) != number) {
    fail(name, number, must_be);
  }
  const int whole = static_cast<int>(number);
  log(name, whole);
  return whole;
}

double ParameterReader::readNumber(const std::string& name, double otherwise,
                                   const std::string& must_be) {
  known_.insert(name);
  XmlRpcValue value;
  if (!node_handle_.getParam(name, value)) {
    return otherwise;
  }
  if (value.getType() == XmlRpcValue::TypeInt) {
    return static_cast<int>(value);
  }
  if (value.getType() != XmlRpcValue::TypeDouble) {
    fail(name, value, must_be);
  }
  return static_cast<double>(value);
}

void ParameterReader::fail(const std::string& name, const XmlRpcValue& value,
                           const std::string& must_be) const {
  std::ostringstream text;
  if (value.getType() == XmlRpcValue::TypeString) {
    text << "'" << static_cast<std::string>(XmlRpcValue(value)) << "'";
  } else if (value.getType() == XmlRpcValue::TypeDouble) {
    text << static_cast<double>(XmlRpcValue(value));
  } else {
    ::operator<<(text, value);  // those of messages would hide it
  }
  throw std::invalid_argument(node_handle_.resolveName(name) + " is " + text.str() +
                              ", it must be " + must_be);
}

void ParameterReader::warnOfUnknown() const {
  std::vector<std::string> names;
  ros::param::getParamNames(names);
  const std::string prefix = node_handle_.getNamespace() + "/";
  std::set<std::string> unknown;
  for (const std::string& name : names) {
    if (name.compare(0, prefix.size(), prefix) == 0) {
      const std::string own = name.substr(prefix.size());
      if (known_.count(own) == 0 && spaces_.count(own.substr(0, own.find('/'))) == 0) {
        unknown.insert(own);
      }
    }
  }
  for (const std::string& name : unknown) {
    ROS_WARN("%s is not a parameter of self_awareness; it is ignored",
             node_handle_.resolveName(name).c_str());
  }
}

}  // namespace self_awareness

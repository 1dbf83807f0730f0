#pragma once

#include <cstddef>
#include <vector>

namespace self_awareness::core::evidence {

/// A part of a recording.
struct Part {
  std::size_t sample = 0;  ///< number of the start, or of the robot, that it is of (samplesOf())
  double hours = 0;
};

/// How often normal operation would have exceeded limits that it was not known to: every sample (a
/// robot, or a start of one) is judged by the others (docs/method.md, section 5.5). Where one is
/// more than half of all, so is every part of it by the other parts.
class LeftOut {
 public:
  /// @param parts all that was looked at; none may be empty
  explicit LeftOut(const std::vector<Part>& parts);

  /// Takes in a track that is judged.
  /// @param largest value in every part, 0 or more
  /// @param agreed the same, as far as it tells about others
  /// @param least limit of the track
  /// @param margin the limit is so many times the largest value that was seen
  void add(const std::vector<double>& largest, const std::vector<double>& agreed, double least,
           double margin);
  /// Parts in which at least one track would have exceeded its limit.
  std::size_t exceeded() const;
  /// Length of the parts that others can judge [h]; of all, where none can be.
  double hours() const;

 private:
  /// Largest value of all groups but one.
  struct Others {
    double largest = 0;
    double second = 0;
    std::size_t group = 0;  // that the largest is of

    void add(double value, std::size_t its_group);
    double without(std::size_t left_out) const { return left_out == group ? second : largest; }
  };
  enum class By { kSample, kPart, kNothing };

  std::vector<Part> parts_;
  std::vector<By> left_out_by_;  // by part
  std::vector<bool> exceeded_;   // by part
};

/// False alarms an hour of a robot that are not more with a probability of 95 %, by what its
/// recordings show, and by what robots are like (docs/method.md, section 5.5).
/// @param exceeded parts whose limits were exceeded
/// @param hours of all parts that were looked at, > 0
double highestRate(std::size_t exceeded, double hours);

}  // namespace self_awareness::core::evidence

#include <pybind11/stl.h>

#include <string>

#include "bindings.h"
#include "ros/bag/version_of_bag.h"
#include "self_awareness/ros/file_version.h"

namespace self_awareness::python {

void bindFileVersions(py::module& m) {
  using self_awareness::FileVersion;
  py::class_<FileVersion>(m, "FileVersion", "msg/FileVersion.msg")
      .def_readonly("kind", &FileVersion::kind)
      .def_readonly("format", &FileVersion::format)
      .def_readonly("oldest_reader", &FileVersion::oldest_reader)
      .def_readonly("method", &FileVersion::method, "0: the file holds nothing that it made")
      .def_readonly("package", &FileVersion::package)
      .def_static(
          "of_event_log",
          [](const std::string& path) { return ros1::readFileVersion(path, ros1::kEventLogFile); },
          py::arg("path"), "BagError if it cannot be read, or is another file.")
      .def_static(
          "of_result_bag",
          [](const std::string& path) { return ros1::readFileVersion(path, ros1::kResultBag); },
          py::arg("path"), "BagError if it cannot be read, or is another file.")
      .def_static(
          "of_graph", [] { return ros1::versionOf(ros1::kGraphFile); },
          "What this version writes into the file beside a bag that says who listens to whom.")
      .def_static(
          "why_graph_too_new",
          [](std::uint32_t format, std::uint32_t oldest_reader, const std::string& package) {
            FileVersion version = ros1::versionOf(ros1::kGraphFile);
            version.format = format;
            version.oldest_reader = oldest_reader;
            version.package = package;
            return ros1::whyUnread(version, ros1::kGraphFile);
          },
          py::arg("format"), py::arg("oldest_reader"), py::arg("package"),
          "Why such a file cannot be read; empty: it can.");
  m.attr("METHOD") = ros1::kMethod;
  m.attr("VERSION") = ros1::kPackageVersion;
}

}  // namespace self_awareness::python

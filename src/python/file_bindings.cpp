#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "ros/bag/version_of_bag.h"
#include "ros/verdict/result_bag.h"
#include "self_awareness/ros/file_version.h"
#include "self_awareness/ros/model/model_file.h"
#include "self_awareness/ros/output_file.h"

namespace self_awareness::python {
void bindFiles(py::module& m) {
  using ros1::OutputFile;
  py::register_exception<ros1::FileError>(m, "FileError", PyExc_OSError);
  py::class_<OutputFile>(m, "OutputFile",
                         "A file that is written whole or not at all; a device or a pipe is\n"
                         "written directly. FileError where it cannot be written.")
      .def(py::init<const std::string&>(), py::arg("path"))
      .def_property_readonly("temporary", &OutputFile::temporary,
                             "What is to be written; its name ends like that of the file.")
      .def("complete", &OutputFile::complete, "Puts it in place. FileError where that fails.")
      .def("close", &OutputFile::close, "Removes it, unless it is complete.");
  m.def("write_problem", &ros1::writeProblem, py::arg("path"), py::arg("error"),
        py::arg("temporary") = "",
        "Why a file cannot be written, in one line. error: as in errno. temporary: what was\n"
        "written so far, if it is removed after that.");

  using self_awareness::FileVersion;
  py::class_<FileVersion>(m, "FileVersion", "msg/FileVersion.msg")
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

void bindResults(py::module& m) {
  using ros1::ReplayedMonitor;
  using ros1::ResultBag;
  py::class_<ResultBag>(m, "ResultBag",
                        "A bag of what the monitor would have published of recordings.")
      .def(py::init<const std::string&, const std::string&>(), py::arg("path"),
           py::arg("named") = "",
           "Creates the file, or empties the one that is there. named: what errors call it, if\n"
           "not by its path. BagError where that fails.")
      .def("close", &ResultBag::close, "Completes the file. BagError where that fails.")
      .def_static("is_one", &ResultBag::isOne, py::arg("path"),
                  "Whether a file is a whole bag that this class wrote, and no recording.");

  py::class_<ReplayedMonitor>(m, "ReplayedMonitor",
                              "Writes into a result bag what the monitor would have said while a\n"
                              "recording was made; given to what judges the recording.")
      .def(py::init([](ResultBag& bag, const std::string& model_path,
                       const ros1::TrainedModel& trained, bool calibrated,
                       const std::vector<core::EventType>& event_types, std::int64_t start,
                       std::vector<core::evidence::Coverage> coverage) {
             const ReplayedMonitor::Model model{model_path, calibrated, trained.window,
                                                trained.vocabulary().size(), std::move(coverage)};
             return std::make_unique<ReplayedMonitor>(bag, model, event_types, start);
           }),
           py::arg("bag"), py::arg("model_path"), py::arg("trained"), py::arg("calibrated"),
           py::arg("event_types"), py::arg("start"),
           py::arg("coverage") = std::vector<core::evidence::Coverage>(), py::keep_alive<1, 2>(),
           "model_path: what the diagnostics call the model. calibrated: there are limits, or a\n"
           "threshold, for the detector. event_types: by id, those of the model first.\n"
           "start: of the recording [ns]. coverage: of the components; none: not known.");
}

}  // namespace self_awareness::python

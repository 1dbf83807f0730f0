#include "bindings.h"
#include "self_awareness/ros/output_file.h"

namespace self_awareness::python {

void bindOutputFiles(py::module& m) {
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
}

}  // namespace self_awareness::python

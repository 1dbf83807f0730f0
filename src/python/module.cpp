// The Python module: gives the package's programs the C++ core and the bag reader. It is as thin
// as possible.

#include "bindings.h"

PYBIND11_MODULE(_core, m) {
  m.doc() = "C++ core of self_awareness: the one implementation of the method.";
  self_awareness::python::bindEncoding(m);
  self_awareness::python::bindRecordings(m);
  self_awareness::python::bindFiles(m);
  self_awareness::python::bindEventLogs(m);
  self_awareness::python::bindModel(m);
  self_awareness::python::bindTuning(m);
  self_awareness::python::bindEvidence(m);
  self_awareness::python::bindLearning(m);
  self_awareness::python::bindResults(m);
  self_awareness::python::bindAlarms(m);
  self_awareness::python::bindIncidents(m);
  self_awareness::python::bindAccepted(m);
  self_awareness::python::bindDetector(m);
  self_awareness::python::bindLanes(m);
  self_awareness::python::bindDrift(m);
}

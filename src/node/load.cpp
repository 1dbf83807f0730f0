#include "load.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace self_awareness {

std::string loadInWords() {
  double load = 0;
  if (getloadavg(&load, 1) != 1) {
    return "";
  }
  const long cores = sysconf(_SC_NPROCESSORS_ONLN);
  char text[60];
  std::snprintf(text, sizeof text, "load %.1f on %ld core%s", load, cores, cores == 1 ? "" : "s");
  return text;
}

}  // namespace self_awareness

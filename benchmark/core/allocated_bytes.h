#pragma once

#include <cstddef>

namespace self_awareness::benchmarks {

/// What operator new has handed out and was not given back [bytes], as malloc rounded it.
std::size_t allocatedBytes();

}  // namespace self_awareness::benchmarks

#pragma once

#include <cstddef>

namespace self_awareness::benchmarks {

/// Memory that operator new has allocated and that is not yet freed [bytes], as malloc rounds it.
std::size_t allocatedBytes();

}  // namespace self_awareness::benchmarks

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "event_loop.h"

namespace {

std::atomic<std::size_t> allocated{0};

}  // namespace

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  allocated += malloc_usable_size(memory);
  return memory;
}

void operator delete(void* memory) noexcept {
  if (memory != nullptr) {
    allocated -= malloc_usable_size(memory);
    std::free(memory);
  }
}

void operator delete(void* memory, std::size_t /*size*/) noexcept {
  operator delete(memory);
}

namespace self_awareness::benchmarks {

std::size_t allocatedBytes() {
  return allocated;
}

}  // namespace self_awareness::benchmarks

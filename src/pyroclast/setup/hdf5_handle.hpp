#pragma once

#include <hdf5.h>

namespace pyroclast {

/// HDF5 identifier that is closed at the end of its scope.
template <herr_t (*Close)(hid_t)>
struct Hdf5Handle {
  hid_t id;

  explicit Hdf5Handle(hid_t opened) : id(opened) {}
  ~Hdf5Handle() {
    if (id >= 0) Close(id);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
};

}  // namespace pyroclast

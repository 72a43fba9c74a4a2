// `#<_hal[...]>`: the interpreter would join the shared memory of a running LinuxCNC. These
// functions are found before those of its library, so that it never does, and reads what kerf has
// been told of the machine instead. Declared here, so that HAL's own header is not needed.
#include <cerrno>

#include "interp_bridge/kerf_interp/recording.h"

extern "C" {
int hal_init(const char* name);
int hal_ready(int component);
/// `type` is a hal_type_t, `data` a pointer to a hal_data_u; of a pin of type float it is a double.
int hal_get_pin_value_by_name(const char* name, int* type, const double** data, bool* connected);
int hal_get_signal_value_by_name(const char* name, int* type, const double** data, bool* driven);
int hal_get_param_value_by_name(const char* name, int* type, const double** data);
}

namespace {

/// A component that the interpreter believes to be.
constexpr int kComponent = 1;
constexpr int kFloatPin = 2;  ///< HAL_FLOAT

}  // namespace

int hal_init(const char*) { return kComponent; }
int hal_ready(int) { return 0; }

int hal_get_pin_value_by_name(const char* name, int* type, const double** data, bool* connected) {
  static double value = 0;  // read before the next call
  if (!kerf::interp::recording().world.hal_value(name, value)) return -ENOENT;
  *connected = true;
  *type = kFloatPin;
  *data = &value;
  return 0;
}

/// Signals and parameters are not told apart from pins: a name is one of them.
int hal_get_signal_value_by_name(const char*, int*, const double**, bool*) { return -ENOENT; }
int hal_get_param_value_by_name(const char*, int*, const double**) { return -ENOENT; }

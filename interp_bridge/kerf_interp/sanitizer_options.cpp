// Only looked for by AddressSanitizer, where this program is built with it.

extern "C" {
/// librs274 deletes its G71 motions by a base class without a virtual destructor, and keeps what
/// Python allocates: its affairs, which must not end ours.
const char* __asan_default_options();
const char* __asan_default_options() { return "new_delete_type_mismatch=0:detect_leaks=0"; }
}

// OpenGL drivers that are unloaded cannot be named by the leak checker, which then blames nobody's code for what they
// keep.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define ILF_LEAKS_ARE_CHECKED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define ILF_LEAKS_ARE_CHECKED
#endif

#if defined(ILF_LEAKS_ARE_CHECKED)
extern "C" int dlclose(void* /*library*/) noexcept { return 0; }
#endif

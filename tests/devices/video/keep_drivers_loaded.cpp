// OpenGL drivers that are unloaded cannot be named by the leak checker, which then blames nobody's code for what they
// keep.
#if defined(__SANITIZE_ADDRESS__)
extern "C" int dlclose(void* /*library*/) noexcept { return 0; }
#endif

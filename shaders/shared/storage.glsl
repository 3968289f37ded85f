// Formats of images that keep 16 bits, and 32 to see what 16 lose (core/gl/storage.h).
#ifdef WIDE_STORAGE
#define STORED_RGBA16F rgba32f
#define STORED_RGBA16 rgba32f
#define STORED_RGBA16_SNORM rgba32f
#else
#define STORED_RGBA16F rgba16f
#define STORED_RGBA16 rgba16
#define STORED_RGBA16_SNORM rgba16_snorm
#endif

/* SHA-256 by the letters of FIPS 180-4. Drawback: processors have instructions for it that are several times
   faster. */
#include "base/sha256.h"
#include "base/plain.h"
#include <string.h>

/* The fractions of the cube roots of the first 64 primes. */
static const uint32_t K[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2 };

static uint32_t turn(uint32_t x, int n) { return x >> n | x << (32 - n); }

/* One block of 64 bytes into the state. */
static void take_block(uint32_t H[8], const unsigned char *m)
{
    uint32_t W[64], a = H[0], b = H[1], c = H[2], d = H[3], e = H[4], f = H[5], g = H[6], h = H[7];
    for (int t = 0; t < 16; t++)
        W[t] = (uint32_t)m[4*t] << 24 | (uint32_t)m[4*t + 1] << 16 | (uint32_t)m[4*t + 2] << 8 | m[4*t + 3];
    for (int t = 16; t < 64; t++) {
        const uint32_t s0 = turn(W[t - 15], 7) ^ turn(W[t - 15], 18) ^ W[t - 15] >> 3;
        const uint32_t s1 = turn(W[t - 2], 17) ^ turn(W[t - 2], 19) ^ W[t - 2] >> 10;
        W[t] = s1 + W[t - 7] + s0 + W[t - 16];
    }
    for (int t = 0; t < 64; t++) {
        const uint32_t S1 = turn(e, 6) ^ turn(e, 11) ^ turn(e, 25), ch = (e & f) ^ (~e & g);
        const uint32_t S0 = turn(a, 2) ^ turn(a, 13) ^ turn(a, 22), maj = (a & b) ^ (a & c) ^ (b & c);
        const uint32_t T1 = h + S1 + ch + K[t] + W[t], T2 = S0 + maj;
        h = g, g = f, f = e, e = d + T1, d = c, c = b, b = a, a = T1 + T2;
    }
    H[0] += a, H[1] += b, H[2] += c, H[3] += d, H[4] += e, H[5] += f, H[6] += g, H[7] += h;
}

/* The last bytes, a bit 1, zeros, and the length in bits. */
static void finish(uint32_t H[8], const unsigned char *rest, size_t left, uint64_t bytes)
{
    unsigned char end[128] = { 0 };
    const size_t size = left < 56 ? 64 : 128;
    memcpy(end, rest, left);
    end[left] = 0x80;
    for (int k = 0; k < 8; k++) end[size - 1 - (size_t)k] = (unsigned char)(8*bytes >> 8*k);
    for (size_t at = 0; at < size; at += 64) take_block(H, end + at);
}

tobi_status tobi_sha256_file(const char *path, char digest[TOBI_SHA256_TEXT], int64_t *size, tobi_error *err)
{
    uint32_t H[8] = { 0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab,
                      0x5be0cd19 };
    unsigned char buffer[64*256];
    size_t n;
    FILE *file;
    TOBI_TRY(tobi_plain_open(path, "file", 0, &file, NULL, err));
    *size = 0;
    do {
        n = fread(buffer, 1, sizeof buffer, file);
        *size += (int64_t)n;
        for (size_t at = 0; at + 64 <= n; at += 64) take_block(H, buffer + at);
    } while (n == sizeof buffer);
    const int failed = ferror(file);
    fclose(file);
    if (failed) return tobi_fail(err, TOBI_IO, "%s: cannot be read to its end", path);
    finish(H, buffer + n/64*64, n%64, (uint64_t)*size);
    for (int k = 0; k < 8; k++) snprintf(digest + 8*k, 9, "%08x", H[k]);
    return TOBI_OK;
}

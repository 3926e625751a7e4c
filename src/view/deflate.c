/* Two walks over each block: the first finds tokens and counts them, the second writes the code of each, by
   a Huffman code made of the counts. Drawback: a block's tokens take two bytes for each of its bytes. */
#include "view/deflate.h"
#include <stdlib.h>
#include <string.h>

enum {
    END = 256, SYMBOLS = 286,    /* bytes, the end, lengths of runs                         */
    LENGTHS = 29, SHORTEST = 3, LONGEST = 258,
    RUN = 256,                   /* the token of a run is this and its length               */
    TOKENS = RUN + LONGEST + 1,
    DEEPEST = 13                 /* bits of a code: three tokens fit into a word, with runs */
};

typedef struct code {
    uint32_t count[SYMBOLS];
    uint8_t  length[SYMBOLS];    /* bits; 0: does not occur */
    uint16_t word[SYMBOLS];      /* first bit lowest        */
} code;

/* Symbol END + 1 + k stands for runs from first[k] on, with so many bits more. */
static const uint16_t first_length[LENGTHS] = { 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35,
                                                43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258 };
static const uint8_t more_bits[LENGTHS] = { 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 4, 4,
                                            4, 4, 5, 5, 5, 5, 0 };

/* Runs below this have the symbol of length k. */
static int beyond_length(int k) { return k < LENGTHS - 1 ? first_length[k + 1] : LONGEST + 1; }

/* Zeros in a row, as one zero and runs that repeat it. */
static uint16_t *put_zeros(uint16_t *token, size_t zeros)
{
    *token++ = 0;
    for (zeros--; zeros >= SHORTEST;) {
        size_t run = zeros < LONGEST ? zeros : LONGEST;
        if (zeros - run < SHORTEST && zeros > run) run -= SHORTEST;      /* the rest is a run, too */
        *token++ = (uint16_t)(RUN + run);
        zeros -= run;
    }
    for (; zeros > 0; zeros--) *token++ = 0;
    return token;
}

/* Four zeros or more are a run. Returns the end of the tokens. */
static uint16_t *find_tokens(const uint8_t *p, const uint8_t *end, uint16_t *token)
{
    while (end - p >= 8) {
        uint64_t eight;
        memcpy(&eight, p, 8);
        if (eight & 0xffffffffu) {
            *token++ = *p++;
            continue;
        }
        const uint8_t *begin = p;
        while (end - p >= 8 && (memcpy(&eight, p, 8), eight == 0)) p += 8;
        while (p < end && *p == 0) p++;
        token = put_zeros(token, (size_t)(p - begin));
    }
    while (p < end) *token++ = *p++;
    return token;
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return p < q ? -1 : p > q;
}

/* Huffman 1952: the two rarest become one, until one is left. Sorted leaves and the nodes made of them are
   two queues. Returns the bits of the longest code. */
static int find_lengths(code *c)
{
    uint64_t key[SYMBOLS], weight[2*SYMBOLS];
    int parent[2*SYMBOLS], depth[2*SYMBOLS], leaves = 0, longest = 0;
    for (int s = 0; s < SYMBOLS; s++)
        if (c->count[s] > 0) key[leaves++] = (uint64_t)c->count[s] << 16 | (uint64_t)s;
    qsort(key, (size_t)leaves, sizeof *key, compare_keys);
    for (int n = 0; n < leaves; n++) weight[n] = key[n] >> 16;
    for (int next = leaves, leaf = 0, inner = leaves; next < 2*leaves - 1; next++) {
        weight[next] = 0;
        for (int k = 0; k < 2; k++) {
            const bool rarer = leaf < leaves && (inner == next || weight[leaf] <= weight[inner]);
            const int n = rarer ? leaf++ : inner++;
            parent[n] = next;
            weight[next] += weight[n];
        }
    }
    depth[2*leaves - 2] = 0;
    for (int n = 2*leaves - 3; n >= 0; n--) depth[n] = depth[parent[n]] + 1;
    memset(c->length, 0, sizeof c->length);
    for (int n = 0; n < leaves; n++) {
        c->length[key[n] & 0xffff] = (uint8_t)depth[n];
        longest = depth[n] > longest ? depth[n] : longest;
    }
    return longest;
}

/* Codes of one length follow each other in the order of their symbols. */
static void find_words(code *c)
{
    for (int length = 1, next = 0; length <= DEEPEST; length++, next <<= 1)
        for (int s = 0; s < SYMBOLS; s++) {
            if (c->length[s] != length) continue;
            int turned = 0;
            for (int k = 0; k < length; k++) turned |= (next >> k & 1) << (length - 1 - k);
            c->word[s] = (uint16_t)turned;
            next++;
        }
}

static void make_code(code *c, const uint16_t *token, const uint16_t *end)
{
    uint32_t count[TOKENS] = { 0 };
    for (; token < end; token++) count[*token]++;
    memcpy(c->count, count, END*sizeof *count);
    memset(c->count + END, 0, (SYMBOLS - END)*sizeof *count);
    for (int k = 0; k < LENGTHS; k++)
        for (int run = first_length[k]; run < beyond_length(k); run++)
            c->count[END + 1 + k] += count[RUN + run];
    c->count[END] = 1;
    while (find_lengths(c) > DEEPEST)
        for (int s = 0; s < SYMBOLS; s++) c->count[s] = (c->count[s] + 1)/2;
    find_words(c);
}

static inline void put(deflater *d, uint64_t bits, int count)
{
    d->bits |= bits << d->held;
    d->held += count;
}

/* Full bytes; at most 7 bits stay. */
static inline uint8_t *flush(deflater *d, uint8_t *out)
{
    for (int k = 0; k < 8; k++) out[k] = (uint8_t)(d->bits >> 8*k);
    const int bytes = d->held/8;
    d->bits = bytes < 8 ? d->bits >> 8*bytes : 0;
    d->held -= 8*bytes;
    return out + bytes;
}

/* Lengths of codes as four bits each, first bit highest; one distance, 1, whose code is one bit. */
static uint8_t *put_head(deflater *d, const code *c, bool last, uint8_t *out)
{
    static const uint8_t turned[16] = { 0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15 };
    put(d, last, 1);
    put(d, 2, 2);                        /* a code of its own */
    put(d, SYMBOLS - 257, 5);
    put(d, 0, 5);                        /* distances, less 1 */
    put(d, 19 - 4, 4);
    out = flush(d, out);
    for (int k = 0; k < 19; k++) {       /* lengths of the lengths' codes; the first three are repeats */
        put(d, k < 3 ? 0 : 4, 3);
        out = flush(d, out);
    }
    for (int s = 0; s < SYMBOLS; s++) {
        put(d, turned[c->length[s]], 4);
        out = flush(d, out);
    }
    put(d, turned[1], 4);
    return flush(d, out);
}

/* Of each token its bits, above the number of them in the lowest five bits. */
static void list_tokens(const code *c, uint32_t entry[TOKENS])
{
    for (int s = 0; s < END; s++) entry[s] = (uint32_t)c->word[s] << 5 | c->length[s];
    for (int k = 0; k < LENGTHS; k++) {
        const int s = END + 1 + k;
        for (int run = first_length[k]; run < beyond_length(k); run++) {
            const uint32_t bits = c->word[s] | (uint32_t)(run - first_length[k]) << c->length[s];
            entry[RUN + run] = bits << 5 | (uint32_t)(c->length[s] + more_bits[k] + 1);      /* distance: 1 */
        }
    }
}

size_t view_deflate(deflater *d, const uint8_t *bytes, size_t count, bool last, uint8_t *out)
{
    const uint8_t *begin = out;
    const uint16_t *t = d->token, *end = find_tokens(bytes, bytes + count, d->token);
    uint32_t entry[TOKENS];
    code c;
    make_code(&c, t, end);
    list_tokens(&c, entry);
    out = put_head(d, &c, last, out);
    for (; end - t >= 3; t += 3) {
        const uint32_t one = entry[t[0]], two = entry[t[1]], three = entry[t[2]];
        put(d, one >> 5, one & 31);
        put(d, two >> 5, two & 31);
        put(d, three >> 5, three & 31);
        out = flush(d, out);
    }
    for (; t < end; t++) {
        put(d, entry[*t] >> 5, entry[*t] & 31);
        out = flush(d, out);
    }
    put(d, c.word[END], c.length[END]);
    out = flush(d, out);
    if (last && d->held > 0) {
        d->held = 8;
        out = flush(d, out);
    }
    return (size_t)(out - begin);
}

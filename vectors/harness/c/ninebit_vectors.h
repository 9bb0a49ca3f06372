/* ninebit_vectors.h: reads tables of vectors (units/UNIT.tsv of a pack). C89, one header, no allocation.
 *
 *     static ninebit_table table;
 *     int a, b, expected;
 *     if (!ninebit_open(&table, file)) { puts(table.error); ... }
 *     a = ninebit_column(&table, "in.a");
 *     while (ninebit_next(&table)) { ... ninebit_number(&table, a) ... }
 *     if (table.error[0]) { ... }
 *
 * Numbers are what the table says. A column of type h may hold halves (12.5), which C's integers do not: ninebit_halves gives any column's
 * number times two. (Packed rows, UNIT.hex, hold halves in the same way: the bits of such a column count halves.)
 *
 * A table is large (see the limits below): keep it static. Dedicated to the public domain (CC0 1.0).
 */
#ifndef NINEBIT_VECTORS_H
#define NINEBIT_VECTORS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The longest line, with its end, and the most columns. Both may be defined before this file is included. */
#ifndef NINEBIT_LINE
#define NINEBIT_LINE 16384
#endif
#ifndef NINEBIT_COLUMNS
#define NINEBIT_COLUMNS 256
#endif

/* A test needs some of the functions; compilers that warn of the others are told. */
#ifdef __GNUC__
#define NINEBIT_OPTIONAL __attribute__((unused))
#else
#define NINEBIT_OPTIONAL
#endif

typedef struct ninebit_table {
    FILE *file;
    long line_number;
    /* Empty while nothing is wrong. */
    char error[160];
    char unit[64];
    char profile[16];
    int columns;
    /* The line of names and the current row, cut at tabs. */
    char head[NINEBIT_LINE];
    char row[NINEBIT_LINE];
    char *names[NINEBIT_COLUMNS];
    char *fields[NINEBIT_COLUMNS];
    /* The letter of a column's type: u, s, h, x, e; 0 for the columns that are text. */
    char types[NINEBIT_COLUMNS];
} ninebit_table;

static int ninebit_fail(ninebit_table *table, const char *message)
{
    sprintf(table->error, "line %ld: %.120s", table->line_number, message);
    return 0;
}

/* Reads a line without its end; 0 at the end of the file or if something is wrong. */
static int ninebit_line(ninebit_table *table, char *into)
{
    size_t length;
    if (!fgets(into, NINEBIT_LINE, table->file)) {
        return ferror(table->file) ? ninebit_fail(table, "the file cannot be read") : 0;
    }
    table->line_number++;
    length = strlen(into);
    if (length == 0 || into[length - 1] != '\n') {
        return ninebit_fail(table, length + 1 < NINEBIT_LINE ? "the file is cut off" : "longer than NINEBIT_LINE");
    }
    into[length - 1] = '\0';
    return 1;
}

/* Cuts a line at its tabs; returns how many fields there are, more than NINEBIT_COLUMNS if they do not fit. */
static int ninebit_split(char *line, char **fields)
{
    int count = 0;
    for (;;) {
        char *tab = strchr(line, '\t');
        if (count == NINEBIT_COLUMNS) return NINEBIT_COLUMNS + 1;
        fields[count++] = line;
        if (!tab) return count;
        *tab = '\0';
        line = tab + 1;
    }
}

/* Copies the value of a header line. */
static void ninebit_value(const char *line, const char *key, char *into, size_t size)
{
    size_t length = strlen(key);
    if (strncmp(line, key, length) == 0) {
        strncpy(into, line + length, size - 1);
        into[size - 1] = '\0';
    }
}

/* Reads the lines before the rows. 1, or 0 with `error` set. */
NINEBIT_OPTIONAL static int ninebit_open(ninebit_table *table, FILE *file)
{
    int types = 0;
    memset(table, 0, sizeof *table);
    table->file = file;
    if (!ninebit_line(table, table->head)) return ninebit_fail(table, "the file is empty or cannot be read");
    if (strcmp(table->head, "# ninebit-vectors 1") != 0) return ninebit_fail(table, "not a table of vectors of version 1");
    do {
        if (!ninebit_line(table, table->head)) return ninebit_fail(table, "the names of the columns are missing");
        ninebit_value(table->head, "# unit ", table->unit, sizeof table->unit);
        ninebit_value(table->head, "# profile ", table->profile, sizeof table->profile);
        if (strncmp(table->head, "# types ", 8) == 0) {
            const char *type = table->head + 8;
            /* Column 0 is the id; it has no type. */
            while (*type && types + 1 < NINEBIT_COLUMNS) {
                table->types[++types] = *type;
                type += strcspn(type, " ");
                type += *type == ' ';
            }
        }
    } while (table->head[0] == '#');
    table->columns = ninebit_split(table->head, table->names);
    if (table->columns > NINEBIT_COLUMNS) return ninebit_fail(table, "more columns than NINEBIT_COLUMNS");
    if (types == 0 || types >= table->columns) return ninebit_fail(table, "types and columns do not match");
    return 1;
}

/* The number of a column, -1 if there is none of that name. */
NINEBIT_OPTIONAL static int ninebit_column(const ninebit_table *table, const char *name)
{
    int column;
    for (column = 0; column < table->columns; column++) {
        if (strcmp(table->names[column], name) == 0) return column;
    }
    return -1;
}

/* Reads the next row. 1; 0 at the end, or with `error` set. */
NINEBIT_OPTIONAL static int ninebit_next(ninebit_table *table)
{
    if (table->error[0] || !ninebit_line(table, table->row)) return 0;
    if (ninebit_split(table->row, table->fields) != table->columns) return ninebit_fail(table, "fields and columns do not match");
    return 1;
}

/* The text of a field of the current row; names of choices, ids and tags are text. Empty for a column that is not there. */
NINEBIT_OPTIONAL static const char *ninebit_text(const ninebit_table *table, int column)
{
    return column >= 0 && column < table->columns ? table->fields[column] : "";
}

/* Twice the number in a field of the current row, whatever the column's type: 24 for 12, 25 for 12.5, -1 for -0.5. */
NINEBIT_OPTIONAL static long ninebit_halves(const ninebit_table *table, int column)
{
    const char *text = ninebit_text(table, column);
    char type = column >= 0 && column < table->columns ? table->types[column] : 0;
    if (type == 'x') return 2 * (long)strtoul(text, NULL, 16);
    return 2 * strtol(text, NULL, 10) + (strchr(text, '.') ? (text[0] == '-' ? -1 : 1) : 0);
}

/* The number in a field of the current row, as it is written there. A word of 32 bits needs a long that holds it. A number that is not
 * whole, which only columns of type h have, is an error: it sets `error` and ends the reading. Ask such columns by ninebit_halves. */
NINEBIT_OPTIONAL static long ninebit_number(ninebit_table *table, int column)
{
    const char *text = ninebit_text(table, column);
    char type = column >= 0 && column < table->columns ? table->types[column] : 0;
    if (type == 'x') return (long)strtoul(text, NULL, 16);
    if (strchr(text, '.')) return ninebit_fail(table, "not a whole number: ask for it by ninebit_halves");
    return strtol(text, NULL, 10);
}

/* Prints the current row with the names of its columns: configuration, inputs, intermediates, results. */
NINEBIT_OPTIONAL static void ninebit_print(const ninebit_table *table, FILE *out)
{
    int column;
    fprintf(out, "row %s (line %ld):", table->fields[0], table->line_number);
    for (column = 1; column < table->columns && table->types[column]; column++) {
        fprintf(out, " %s=%s", table->names[column], table->fields[column]);
    }
    fputc('\n', out);
}

#endif

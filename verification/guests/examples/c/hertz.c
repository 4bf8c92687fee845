/* Hertz's contact as a program for coatcheck: cc -O2 -o hertz hertz.c -lm. No JSON library is needed: the names
   that are read occur once in a question, but for E and nu, whose last ones are those of the substrate. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double number(const char *at, const char *name) { return strtod(strstr(at, name) + strlen(name), NULL); }

int main(void)
{
    char *line = NULL;
    size_t size = 0;
    const double pi = acos(-1.0);
    while (getline(&line, &size, stdin) > 0) {
        const char *substrate = strstr(line, "\"substrate\":"), *id = strstr(line, "\"id\":\"") + 6;
        const char *surface = strstr(line, "\"line\":\"surface\"");
        double R = number(line, "\"radius\":"), W = number(line, "\"load\":");
        double E = number(substrate, "\"E\":"), nu = number(substrate, "\"nu\":");
        double a = cbrt(3 * W * R * (1 - nu * nu) / (4 * E)), p0 = 3 * W / (2 * pi * a * a);
        printf("COATCHECK {\"protocol\":\"coatcheck-guest/1\",\"id\":\"%.*s\",\"values\":{\"contact\":{"
               "\"contact_radius\":%.17g,\"approach\":%.17g,\"peak_pressure\":%.17g}",
               (int)strcspn(id, "\""), id, a, a * a / R, p0);
        if (surface) {
            char *x = strstr(surface, "\"x\":[") + 5, *next;
            printf(",\"surface\":{\"pressure\":");
            for (char comma = '[';; comma = ',', x = next + 1) {
                double r = strtod(x, &next) / a;
                printf("%c%.17g", comma, r < 1 ? p0 * sqrt(1 - r * r) : 0.0);
                if (*next == ']') break;
            }
            printf("]}");
        }
        printf("}}\n");
        fflush(stdout);
    }
    free(line);
    return 0;
}

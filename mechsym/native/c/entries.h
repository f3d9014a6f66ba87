/* What the shared object exports for the function MS_NAME with MS_NX inputs and MS_NY outputs. */

MS_EXPORT void MS_(_point)(const double *k, const double *x, double *y)
{
    MS_(_rows1)(k, x, y);
}

/* n points; where moving[i] is 0, x[i] points to one number for all of them. Returns 0, or -1 without memory. */
MS_EXPORT int MS_(_batch)(long n, const double *k, const double *const *x, const _Bool *moving, double *const *y)
{
    enum { chunk = 256, nx = MS_NX > 0 ? MS_NX : 1 };
    const double *in[nx];
    double *out[MS_NY], *held = malloc(sizeof(double) * nx * chunk);
    if (!held)
        return -1;
    for (int i = 0; i < MS_NX; i++)
        for (long p = 0; p < chunk && p < n && !moving[i]; p++)
            held[i * chunk + p] = *x[i];
    for (long start = 0; start < n; start += chunk) {
        for (int i = 0; i < MS_NX; i++)
            in[i] = moving[i] ? x[i] + start : held + i * chunk;
        for (int i = 0; i < MS_NY; i++)
            out[i] = y[i] + start;
        MS_(_block)(n - start < chunk ? n - start : chunk, k, in, out);
    }
    free(held);
    return 0;
}

#ifdef MS_PYTHON
/* Called from Python with MS_NX floats; self holds the constants. */
static PyObject *MS_(_call)(PyObject *self, PyObject *const *arguments, Py_ssize_t count)
{
    double x[MS_NX > 0 ? MS_NX : 1], y[MS_NY];
    if (count != MS_NX)
        return PyErr_Format(PyExc_TypeError, "%s takes %d numbers, not %zd", MS_TEXT, MS_NX, count);
    for (int i = 0; i < MS_NX; i++) {
        PyObject *a = arguments[i];
        x[i] = PyFloat_CheckExact(a) ? PyFloat_AS_DOUBLE(a) : PyFloat_AsDouble(a);
        if (x[i] == -1.0 && PyErr_Occurred())
            return NULL;
    }
    MS_(_point)((const double *)PyBytes_AS_STRING(self), x, y);
    return ms_floats(y, MS_NY);
}

/* Called with MS_NX columns or numbers and perhaps out=; self holds the constants, a function that makes arrays, the
 * kind of doubles, and what is called instead where these are not all plain. */
static PyObject *MS_(_columns)(PyObject *self, PyObject *const *arguments, Py_ssize_t count, PyObject *names)
{
    enum { nx = MS_NX > 0 ? MS_NX : 1 };
    PyObject *const doubles = PyTuple_GET_ITEM(self, 2), *const constants = PyTuple_GET_ITEM(self, 0);
    Py_buffer views[nx], target = {.obj = NULL};
    double numbers[nx], *y[MS_NY];
    const double *x[nx];
    _Bool moving[nx];
    Py_ssize_t sizes[nx], n = 1, seen = 0;
    int failed = 0, named = names && PyTuple_GET_SIZE(names) > 0;
    int plain = count == MS_NX && (!named || (PyTuple_GET_SIZE(names) == 1
        && !PyUnicode_CompareWithASCIIString(PyTuple_GET_ITEM(names, 0), "out")));
    for (; plain && seen < MS_NX; seen++) {
        sizes[seen] = ms_column(arguments[seen], doubles, views + seen, numbers + seen, x + seen);
        n = sizes[seen] > n ? sizes[seen] : n;
        plain = sizes[seen] > 0;
    }
    for (int i = 0; plain && i < MS_NX; i++) {
        moving[i] = sizes[i] > 1;
        plain = sizes[i] == 1 || sizes[i] == n;
    }
    PyObject *result = NULL;
    if (plain && (!named || arguments[MS_NX] == Py_None))
        result = PyObject_CallFunction(PyTuple_GET_ITEM(self, 1), "((in))", MS_NY, n);
    else if (plain)
        result = Py_NewRef(arguments[MS_NX]);
    if (result && ms_writable(result, doubles, &target, MS_NY, n)) {
        for (int i = 0; i < MS_NY; i++)
            y[i] = (double *)target.buf + i * n;
        Py_BEGIN_ALLOW_THREADS
        failed = MS_(_batch)(n, (const double *)PyBytes_AS_STRING(constants), x, moving, y);
        Py_END_ALLOW_THREADS
    } else {
        Py_CLEAR(result);
    }
    for (int i = 0; i < seen; i++)
        if (views[i].obj)
            PyBuffer_Release(views + i);
    if (target.obj)
        PyBuffer_Release(&target);
    if (!result || failed) {
        PyErr_Clear();
        Py_XDECREF(result);
        return PyObject_Vectorcall(PyTuple_GET_ITEM(self, 3), arguments, count, names);
    }
    return result;
}

static PyMethodDef MS_(_batched) = {
    MS_TEXT, (PyCFunction)(void (*)(void))MS_(_columns), METH_FASTCALL | METH_KEYWORDS, NULL};
static PyMethodDef MS_(_method) = {MS_TEXT, (PyCFunction)(void (*)(void))MS_(_call), METH_FASTCALL, NULL};
#endif

/* Names and the Python side that every emitted file starts with. */
#define MS_EXPORT __attribute__((visibility("default")))
#define MS_PASTE2(a, b) a##b
#define MS_PASTE(a, b) MS_PASTE2(a, b)
#define MS_TEXT2(a) #a
#define MS_TEXT1(a) MS_TEXT2(a)
#define MS_(suffix) MS_PASTE(MS_NAME, suffix)
#define MS_TEXT MS_TEXT1(MS_NAME)

#ifdef MS_PYTHON
static PyObject *ms_floats(const double *y, int count)
{
    if (count == 1)
        return PyFloat_FromDouble(y[0]);
    PyObject *tuple = PyTuple_New(count);
    for (int i = 0; tuple && i < count; i++) {
        PyObject *number = PyFloat_FromDouble(y[i]);
        if (!number) {
            Py_DECREF(tuple);
            return NULL;
        }
        PyTuple_SET_ITEM(tuple, i, number);
    }
    return tuple;
}

/* Whether an array says that it holds doubles; asking for the buffer's format would have numpy write it each time. */
static int ms_doubles(PyObject *array, PyObject *doubles)
{
    static PyObject *name;
    if (!name && !(name = PyUnicode_InternFromString("dtype")))
        return 0;
    PyObject *kind = PyObject_GetAttr(array, name);
    Py_XDECREF(kind);
    return kind == doubles;
}

/* A number, or an array of doubles in one piece. Returns how many numbers, or 0 for anything else. */
static Py_ssize_t ms_column(PyObject *value, PyObject *doubles, Py_buffer *view, double *number, const double **x)
{
    view->obj = NULL;
    *x = number;
    if (PyFloat_Check(value) || PyLong_CheckExact(value)) {
        *number = PyFloat_AsDouble(value);
        return *number == -1.0 && PyErr_Occurred() ? 0 : 1;
    }
    if (!ms_doubles(value, doubles) || PyObject_GetBuffer(value, view, PyBUF_C_CONTIGUOUS))
        return 0;
    *x = view->buf;
    return view->len / (Py_ssize_t)sizeof(double);
}

/* The buffer of an array (count, n) of doubles that may be written into. */
static int ms_writable(PyObject *array, PyObject *doubles, Py_buffer *view, Py_ssize_t count, Py_ssize_t n)
{
    if (!ms_doubles(array, doubles) || PyObject_GetBuffer(array, view, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE))
        return view->obj = NULL, 0;
    return view->ndim == 2 && view->shape[0] == count && view->shape[1] == n;
}
#endif

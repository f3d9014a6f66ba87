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
#endif

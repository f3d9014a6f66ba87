/* The file as a Python module `mechsym_native`: bind(number, constants) gives a function of floats, and
 * bind(number, (constants, empty, doubles, otherwise)) one of columns. */
#ifdef MS_PYTHON
static PyObject *ms_bind(PyObject *module, PyObject *arguments)
{
    (void)module;
    int number;
    PyObject *held;
    if (!PyArg_ParseTuple(arguments, "iO", &number, &held))
        return NULL;
    if (number < 0 || number >= (int)(sizeof ms_methods / sizeof *ms_methods))
        return PyErr_Format(PyExc_IndexError, "no function %d", number);
    return PyCFunction_New((PyTuple_Check(held) ? ms_batched : ms_methods)[number], held);
}

static PyMethodDef ms_module_methods[] = {{"bind", ms_bind, METH_VARARGS, NULL}, {NULL, NULL, 0, NULL}};
static PyModuleDef_Slot ms_slots[] = {{0, NULL}};
static struct PyModuleDef ms_module = {
    .m_base = PyModuleDef_HEAD_INIT, .m_name = "mechsym_native", .m_methods = ms_module_methods, .m_slots = ms_slots};

PyMODINIT_FUNC PyInit_mechsym_native(void)
{
    return PyModuleDef_Init(&ms_module);
}
#endif

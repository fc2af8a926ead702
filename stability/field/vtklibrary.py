"""Other VTK files than .vtu and .vts, by VTK itself (extra ``vtk``): imported only where one is read."""

from pathlib import Path

from stability.errors import SceneError


def xml_of(path: Path) -> bytes:
    """Return a file of another format as VTK's own XML of a structured or an unstructured grid."""
    from vtkmodules.vtkCommonDataModel import vtkStructuredGrid
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    from vtkmodules.vtkIOLegacy import vtkDataSetReader
    from vtkmodules.vtkIOXML import (
        vtkXMLGenericDataObjectReader,
        vtkXMLStructuredGridWriter,
        vtkXMLUnstructuredGridWriter,
    )

    reader = vtkDataSetReader() if path.suffix == ".vtk" else vtkXMLGenericDataObjectReader()
    reader.SetFileName(str(path))
    if path.suffix == ".vtk":  # else only the first array of each kind would be read
        for kind in ("Scalars", "Vectors", "Tensors", "Fields"):
            getattr(reader, f"ReadAll{kind}On")()
    reader.Update()
    data = reader.GetOutput()
    if data is None or not data.GetNumberOfPoints():
        raise SceneError(f"{path.name}: VTK finds no points in it")
    writer = vtkXMLStructuredGridWriter() if isinstance(data, vtkStructuredGrid) else vtkXMLUnstructuredGridWriter()
    if not isinstance(data, vtkStructuredGrid):
        joined = vtkAppendFilter()
        joined.AddInputData(data)
        joined.Update()
        data = joined.GetOutput()
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    writer.SetDataModeToBinary()
    writer.Write()
    return writer.GetOutputString().encode()
